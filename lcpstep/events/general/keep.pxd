cimport cython
from lcpstep.events.general.held cimport project
from lcpstep.events.general.motion cimport state_at
from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.clock cimport RESOLUTION
from lcpstep.kernels.record cimport LEAD, LENGTH, Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, after

cdef void log(
    Mechanism s, Record record, Tally tally, double t, Py_ssize_t c, Py_ssize_t kind, double before,
    double after_, double p
) noexcept nogil
cdef void keep_wanted(Mechanism s, Record record) noexcept nogil
cdef void keep_event(Mechanism s, Record record, double t) noexcept nogil
cdef void keep(Mechanism s, Record record, double t) noexcept nogil
@cython.locals(due=bint)
cdef void pay(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void store_dense(Mechanism s, Record record) noexcept nogil
