from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t FAILED, MAX_ITERATIONS, RAY, SOLVED, NOTHING
cdef double TIE

cdef Py_ssize_t lemke(Py_ssize_t n, Py_ssize_t max_pivots, double smallest, bint keep, Workspace work) noexcept nogil
cdef Py_ssize_t start(Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t first_leaving(Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t ratio_test(Py_ssize_t m, Py_ssize_t n, double smallest, Workspace work) noexcept nogil
cdef double first_zero(Py_ssize_t m, Py_ssize_t n, double smallest, Workspace work) noexcept nogil
cdef Py_ssize_t list_ties(double bound, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t keep_lowest(Py_ssize_t j, Py_ssize_t tied, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef double perturbation(Py_ssize_t variable, Py_ssize_t j, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t advance(
    Py_ssize_t entering, Py_ssize_t leaving, Py_ssize_t m, Py_ssize_t n, Workspace work
) noexcept nogil
cdef void keep_ray(Py_ssize_t entering, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
