cdef double HELD

cdef void mobilities(
    double* H, double* X, Py_ssize_t* ids, Py_ssize_t n_k, double* W, Py_ssize_t n, Py_ssize_t n_q
) noexcept nogil
cdef void forget_rounding(double* left, double* row, Py_ssize_t n_q) noexcept nogil
