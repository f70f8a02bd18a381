cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef bint hold(Model m, Plan plan, Work w, Record record, Py_ssize_t place, double t) noexcept nogil
cdef Py_ssize_t answered(Plan plan, Work w, Py_ssize_t place) noexcept nogil
@cython.locals(closed=bint)
cdef Py_ssize_t choose_resting(Work w) noexcept nogil
cdef double leaving(Model m, Work w, double* W, Py_ssize_t k, Py_ssize_t n_k) noexcept nogil
cdef bint pulls(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef bint weighs(Model m, Work w, Py_ssize_t c, double force) noexcept nogil
cdef double force_rounding(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef double jerked(Work w, double* W, Py_ssize_t c) noexcept nogil
@cython.locals(more=bint)
cdef double largest_connected(Work w, Py_ssize_t c) noexcept nogil
cdef void zero_rounding(Plan plan, Work w) noexcept nogil
cdef bint land(Model m, Plan plan, Work w, Record record, double t, double tau) noexcept nogil
