cimport cython
from lcpstep.events.general.state cimport Mechanism

cdef Py_ssize_t DONE, NOT_FINITE, NO_FORCES
cdef double MOMENT, DOUBTFUL

@cython.locals(opened=bint, doubtful=bint)
cdef Py_ssize_t balanced_forces(Mechanism s, double t) noexcept nogil
cdef bint opens(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(known=bint)
cdef bint change_soon(Mechanism s, double t, double tau) noexcept nogil
