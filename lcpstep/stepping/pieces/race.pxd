from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double CLOSE, SHORT

cdef Py_ssize_t race(
    Model m, Plan plan, Work w, Record record, double t, double sigma, double end, Py_ssize_t most
) noexcept nogil
cdef void keep_impact(Work w, Record record, double t, double tau) noexcept nogil
cdef double next_zero(Work w, Py_ssize_t c, double end) noexcept nogil
cdef bint ordinary(Model m, Plan plan, Work w, Py_ssize_t c, double tau) noexcept nogil
cdef void hit(Model m, Work w, Py_ssize_t c, double tau, double end) noexcept nogil
cdef void gather(Work w, double now, Py_ssize_t struck) noexcept nogil
