cdef double DEPENDENT

cdef bint factorise(double* A, Py_ssize_t* pivots, Py_ssize_t n) noexcept nogil
cdef void solve(double* A, Py_ssize_t* pivots, double* x, Py_ssize_t n) noexcept nogil
cdef bint positive_definite(double* A, Py_ssize_t n) noexcept nogil
cdef void solve_definite(double* L, double* x, Py_ssize_t n) noexcept nogil
cdef void solve_factored(double* L, Py_ssize_t stride, Py_ssize_t n, double* x) noexcept nogil
cdef bint grow_factor(
    double* D, Py_ssize_t n_D, double* L, Py_ssize_t n_L, Py_ssize_t* rows, double* doubt, Py_ssize_t k
) noexcept nogil
