cdef double ROUNDING

cdef double solve_closed(
    double* W, double* b, double* z, Py_ssize_t n, double* w, double* s, double tolerance
) noexcept nogil
cdef double solve_one(double* W, double* b, double* z, double* w, double* s) noexcept nogil
cdef double solve_two(double* W, double* b, double* z, double* w, double* s, double tolerance) noexcept nogil
cdef bint cramer(double* W, double* b, double* z, Py_ssize_t basis) noexcept nogil
