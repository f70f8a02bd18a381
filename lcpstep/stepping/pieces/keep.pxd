from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef void keep_times(Work w, Record record, double now, double before) noexcept nogil
cdef void keep_now(Work w, Record record, double until) noexcept nogil
cdef void remember(Work w) noexcept nogil
cdef void keep_between(Model m, Plan plan, Work w, Record record, double base, double tau, double end) noexcept nogil
cdef void keep(Work w, Record record, double t, double jump) noexcept nogil
