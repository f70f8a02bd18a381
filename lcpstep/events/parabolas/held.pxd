cimport cython
from lcpstep.events.parabolas.state cimport Mechanism

cdef double DRIFT

cdef bint joints_own(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void hold_contacts(Mechanism s) noexcept nogil
cdef void accelerate(Mechanism s) noexcept nogil
cdef void note(Mechanism s, double* a) noexcept nogil
cdef bint drifts(Mechanism s, double* a, Py_ssize_t c) noexcept nogil
