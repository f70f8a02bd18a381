from lcpstep.lcp.workspace cimport Workspace

cdef long long INFINITE, LARGEST_POWER, SMALLEST_POWER
cdef int MANTISSA
cdef Py_ssize_t TILE

cdef void equilibrate(double* W, double* b, Py_ssize_t n, Workspace work) noexcept nogil
cdef void balance(double* W, double* r, double* c, Py_ssize_t n) noexcept nogil
cdef double inverse_power(double x) noexcept nogil
cdef bint all_finite(double* W, double* b, Py_ssize_t n) noexcept nogil
