cimport cython
from lcpstep.lcp.workspace cimport Workspace

cdef Py_ssize_t MAX_ITERATIONS, RAY, SOLVED, CORRECTIONS, MOST, CACHED, LARGE, NOTHING
cdef double SMALLEST_PIVOT, TIE, ROUNDING

cdef Py_ssize_t pivot_tableau(Py_ssize_t n, Py_ssize_t max_pivots, Workspace work) noexcept nogil
cdef Py_ssize_t last_lowest(double* q, Py_ssize_t n) noexcept nogil
cdef void advance(Py_ssize_t p, Py_ssize_t s, Py_ssize_t n, Workspace work) noexcept nogil
cdef void bring_up_to_date(Py_ssize_t s, Py_ssize_t until, Py_ssize_t n, Workspace work) noexcept nogil
cdef void make_all(double* column, Py_ssize_t k, Py_ssize_t until, Py_ssize_t n, Workspace work) noexcept nogil
cdef void make(double* column, Py_ssize_t k, Py_ssize_t n, Workspace work) noexcept nogil
@cython.locals(some=bint)
cdef void make_four(double* column, Py_ssize_t k, Py_ssize_t n, Workspace work) noexcept nogil
cdef void change_all(Py_ssize_t n, Workspace work) noexcept nogil
cdef void subtract_errors(double* q, double* w, Py_ssize_t n, Workspace work) noexcept nogil
cdef void list_by_changes(Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t list_ties(Py_ssize_t s, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t first_of_ties(
    Py_ssize_t tied, Py_ssize_t s, Py_ssize_t n, Workspace work
) noexcept nogil
cdef Py_ssize_t leave_out(Py_ssize_t variable, Py_ssize_t tied, Workspace work) noexcept nogil
cdef Py_ssize_t keep_lowest(
    Py_ssize_t c, Py_ssize_t tied, Py_ssize_t s, Py_ssize_t n, Workspace work
) noexcept nogil
cdef double correct(double* W, double* b, double* z, Py_ssize_t n, double tolerance, Workspace work) noexcept nogil
cdef void read_off(double* q, double least, double* z, Py_ssize_t n, Workspace work) noexcept nogil
cdef double row_error(Py_ssize_t n, Workspace work) noexcept nogil
cdef void mark_basis(Py_ssize_t n, Workspace work) noexcept nogil
