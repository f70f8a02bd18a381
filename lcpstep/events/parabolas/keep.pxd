cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record

cdef void keep_wanted(Mechanism s, Record record) noexcept nogil
cdef void keep_event(Mechanism s, Record record, double t) noexcept nogil
cdef void keep(Mechanism s, Record record, double t) noexcept nogil
@cython.locals(due=bint)
cdef void pay(Mechanism s, Py_ssize_t c) noexcept nogil
