cimport cython
from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t ENOUGH, FAILED, INFEASIBLE, PER_UNKNOWN, RAY, SOLVED, FEW, EXCHANGES, LAST_EXCHANGES, SPREADING, MOST, STARTS, FEWEST_STARTS, STRIDE, PER_SQUARE, THOROUGH, PATIENT, MULTIPLIER, MODULUS, SIXTHS, TINY
cdef double TOLERANCE, STRICT, ALMOST, SMALLEST_PIVOT, LARGER_PIVOT

cdef Py_ssize_t solve_small(double* W, double* b, double* z, Py_ssize_t n, Workspace work) noexcept nogil
@cython.locals(promising=bint)
cdef Py_ssize_t solve_dense(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t max_pivots, Workspace work
) noexcept nogil
cdef Py_ssize_t pivot_fast(
    double* W, double* b, double* z, Py_ssize_t n, double strict, Py_ssize_t max_pivots, Workspace work
) noexcept nogil
cdef Py_ssize_t pivot_on(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t max_pivots, Workspace work
) noexcept nogil
@cython.locals(open_question=bint)
cdef Py_ssize_t conclude(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Py_ssize_t status, Workspace work
) noexcept nogil
@cython.locals(number=cython.longlong)
cdef void choose_start(Py_ssize_t attempt, Py_ssize_t n, Workspace work) noexcept nogil
@cython.locals(some=bint)
cdef bint choose_positive(double* z, Py_ssize_t n, Workspace work) noexcept nogil
@cython.locals(some=bint)
cdef bint choose_negative(double* b, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t exchange_at_last(
    double* W, double* b, double* z, Py_ssize_t n, double tolerance, Workspace work
) noexcept nogil
cdef Py_ssize_t number_of_starts(Py_ssize_t n, Workspace work) noexcept nogil
