cimport cython
from lcpstep.lcp.workspace cimport Workspace

cdef double SINGULAR, PREFERENCE
cdef Py_ssize_t TOGETHER, LARGE

cdef Py_ssize_t largest_below(double* F, Py_ssize_t s, Py_ssize_t k, Py_ssize_t n) noexcept nogil
cdef void swap_rows(double* F, Py_ssize_t i, Py_ssize_t j, Py_ssize_t k, Py_ssize_t n) noexcept nogil
cdef void swap_columns(double* F, Py_ssize_t i, Py_ssize_t j, Py_ssize_t k, Py_ssize_t n) noexcept nogil
cdef Py_ssize_t factorise(double* F, Py_ssize_t k, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t leave_out(double* F, Py_ssize_t s, Py_ssize_t k, Py_ssize_t n, Workspace work) noexcept nogil
cdef void back_substitute(double* F, double* y, Py_ssize_t k, Py_ssize_t n) noexcept nogil
cdef bint invert(double* V, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef void clear_column(double* V, Py_ssize_t s, Py_ssize_t m, Py_ssize_t n) noexcept nogil
@cython.locals(some=bint)
cdef void take_off(double* F, Py_ssize_t done, Py_ssize_t s, Py_ssize_t k, Py_ssize_t n, double* by) noexcept nogil
