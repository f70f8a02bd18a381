cimport cython
from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t FAILED, MAX_ITERATIONS, SOLVED, REFINEMENTS, PATIENCE
cdef double ROUNDING, UNDECIDED, NOISE

cdef Py_ssize_t exchange_indices(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t limit, Workspace work
) noexcept nogil
@cython.locals(good_enough=bint)
cdef bint solve_chosen(double* W, double* b, double* z, Py_ssize_t n, double tolerance, Workspace work) noexcept nogil
@cython.locals(some=bint)
cdef void drop_noise(double* W, double* b, double* z, Py_ssize_t n, Py_ssize_t k, Workspace work) noexcept nogil
cdef Py_ssize_t load(double* W, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t list_chosen(Py_ssize_t n, Workspace work) noexcept nogil
cdef double row_error(Py_ssize_t k, Workspace work) noexcept nogil
cdef Py_ssize_t change_sides(double* W, double* z, Py_ssize_t n, double tolerance, Workspace work) noexcept nogil
@cython.locals(cut=bint)
cdef double clip(double* W, double* b, double* z, Py_ssize_t n, Workspace work) noexcept nogil
cdef void keep_best(double* W, double* b, double* z, Py_ssize_t n, Workspace work) noexcept nogil
