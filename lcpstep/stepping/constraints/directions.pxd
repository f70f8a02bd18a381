from lcpstep.kernels.linear cimport solve_definite
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport after


cdef void mobilities(
    double* H, double* X, Py_ssize_t* ids, Py_ssize_t n_k, double* W, Py_ssize_t n, Py_ssize_t n_q
) noexcept nogil
cdef void divide_by_mass(
    bint constant, double* inverse, double* L, double* row, double* out, Py_ssize_t n_q
) noexcept nogil
