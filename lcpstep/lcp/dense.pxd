from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t ENOUGH, FAILED, INFEASIBLE, MAX_ITERATIONS, PER_UNKNOWN, RAY, SOLVED, NOT_FINITE, TINY, LARGEST_KEPT, LARGEST_ENUMERATION

cdef Workspace space_for(Py_ssize_t n)
cdef Py_ssize_t pivot_once(
    double* W, double* b, double* z, Py_ssize_t n, double* w, double tolerance, Py_ssize_t limit, Workspace work
) noexcept
cdef Py_ssize_t enumerate_all(
    double* W, double* b, double* z, Py_ssize_t n, double* w, double tolerance, Py_ssize_t limit, Workspace work
) noexcept
cdef void solve_all(
    double* matrices, bint shared, double* b, double* z, double* w, Py_ssize_t* status, Py_ssize_t* iterations, double* residual, Py_ssize_t m, Py_ssize_t n, double tolerance, Py_ssize_t limit, Workspace work
) noexcept
cdef object ray(Workspace work, Py_ssize_t n)
cdef object array_of(double* x, Py_ssize_t n)
cdef object search(
    object W, object b, object z, object w, double tol, Py_ssize_t limit, Workspace work, Py_ssize_t status
)
cdef object told(object W, object b, object z, object w, Workspace work, Py_ssize_t status)
