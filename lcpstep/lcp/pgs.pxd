cdef Py_ssize_t MAX_ITERATIONS, SOLVED, SWEEPS, BETWEEN

cdef void sweep(
    Py_ssize_t* starts, Py_ssize_t* columns, double* W, double* b, double* z, Py_ssize_t n, Py_ssize_t count
) noexcept nogil
