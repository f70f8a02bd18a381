cimport cython
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.kernels.record cimport Record

cdef void keep(Rubbing s, Record record, double t, double* y) noexcept nogil
cdef void pay(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void put_on_account(Rubbing s) noexcept nogil
cdef void keep_event(Rubbing s, Record record, double t) noexcept nogil
