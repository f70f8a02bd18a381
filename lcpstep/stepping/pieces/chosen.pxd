from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef bint solve_chosen(
    Model m, Plan plan, Work w, double* W, Py_ssize_t place, Py_ssize_t n, Py_ssize_t guess
) noexcept nogil
cdef void loosen(Model m, Plan plan, Work w, Py_ssize_t n, bint forces) noexcept nogil
cdef bint solve_together(
    Model m, Plan plan, Work w, double* W, Py_ssize_t place, Py_ssize_t n, Py_ssize_t guess
) noexcept nogil
