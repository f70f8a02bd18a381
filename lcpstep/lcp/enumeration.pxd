from lcpstep.lcp.principal cimport clip, solve_chosen
from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t FAILED, MAX_ITERATIONS, SOLVED

cdef Py_ssize_t enumerate_bases(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t limit, Workspace work
) noexcept nogil
