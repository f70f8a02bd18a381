cdef class SparseRows:
    cdef readonly dict arrays
    cdef Indices begin, column
    cdef Doubles value
    cdef readonly Py_ssize_t m
