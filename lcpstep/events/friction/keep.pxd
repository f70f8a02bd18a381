cimport cython
from lcpstep.events.friction.state cimport NOISE, Rubbing
from lcpstep.kernels.clock cimport RESOLUTION
from lcpstep.kernels.record cimport LEAD, LENGTH, Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, after

cdef void log(
    Rubbing s, Record record, Tally tally, double t, Py_ssize_t c, Py_ssize_t kind, double before, double after_,
    double p
) noexcept nogil
cdef void keep(Rubbing s, Record record, double t, double* y) noexcept nogil
cdef void pay(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void put_on_account(Rubbing s) noexcept nogil
cdef void keep_event(Rubbing s, Record record, double t) noexcept nogil
cdef void store_dense(Rubbing s, Record record) noexcept nogil
