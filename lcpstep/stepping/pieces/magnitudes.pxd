from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double FAINT, LEAST

cdef double speed_terms(Plan plan, Work w, Py_ssize_t c) noexcept nogil
cdef bint faint(Plan plan, Work w, Py_ssize_t c, double u) noexcept nogil
cdef double acceleration_terms(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef void acting(Model m, Work w) noexcept nogil
