cimport cython
from lcpstep.pointers cimport Doubles, Indices


@cython.final
cdef class SparseRows:
    cdef readonly dict arrays
    cdef Indices begin, column
    cdef Doubles value
    cdef readonly Py_ssize_t m
    cpdef object times(self, object x)
    cpdef object sizes(self, object x)


cdef void add_products(SparseRows A, Py_ssize_t m, double factor, double* x, double* target) noexcept nogil
cdef void add_sizes(SparseRows A, Py_ssize_t m, double* x, double* target) noexcept nogil
