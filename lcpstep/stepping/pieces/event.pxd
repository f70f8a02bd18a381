cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t event(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
cdef void lift(Model m, Plan plan, Work w, double* x, Py_ssize_t c, double distance) noexcept nogil
cdef void straighten(Model m, Plan plan, Work w, Py_ssize_t d) noexcept nogil
cdef void straighten_all(Model m, Work w, Py_ssize_t n_s) noexcept nogil
cdef double height(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef void remeasure(Model m, Plan plan, Work w) noexcept nogil
@cython.locals(first=Py_ssize_t, touches=bint)
cdef Py_ssize_t struck_at_start(Work w) noexcept nogil
