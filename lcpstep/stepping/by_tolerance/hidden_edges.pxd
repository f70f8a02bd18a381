cdef class Edges:
    cdef object kept
    cdef Py_ssize_t n_c
    cdef bint passed
    cdef double depth
    cdef Doubles bend, forced, below
