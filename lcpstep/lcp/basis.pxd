from lcpstep.lcp.workspace cimport Workspace

cdef double DRIFT

cdef void set_direction(Py_ssize_t entering, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef void solve_direction(Py_ssize_t entering, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef void follow(Py_ssize_t entering, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef double drift(Py_ssize_t m, Workspace work) noexcept nogil
cdef void refine(double* x, double* w, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef bint refactorise(Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t pivot(Py_ssize_t entering, Py_ssize_t leaving, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t replace_column(Py_ssize_t j, Py_ssize_t q, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t replace_row(Py_ssize_t p, Py_ssize_t i, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t add_row_and_column(
    Py_ssize_t j, Py_ssize_t i, Py_ssize_t m, Py_ssize_t n, Workspace work
) noexcept nogil
cdef void left_product(Py_ssize_t i, Py_ssize_t m, Py_ssize_t n, Workspace work) noexcept nogil
cdef Py_ssize_t drop_row_and_column(
    Py_ssize_t p, Py_ssize_t q, Py_ssize_t m, Py_ssize_t n, Workspace work
) noexcept nogil
