from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t FAILED, MAX_ITERATIONS, SOLVED

cdef Py_ssize_t enumerate_bases(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t limit, Workspace work
) noexcept nogil
cdef Py_ssize_t enumerate_vertices(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Workspace work
) noexcept nogil
cdef Py_ssize_t size_of(Py_ssize_t subset) noexcept nogil
cdef bint solve_pair(
    double* W, double* b, double* z, Py_ssize_t n, Py_ssize_t rows, Py_ssize_t columns, Workspace work
) noexcept nogil
