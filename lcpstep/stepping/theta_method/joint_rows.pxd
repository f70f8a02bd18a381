cdef class Elimination:
    cdef object numbers, integers
    cdef Py_ssize_t n_j
    cdef bint redundant, swept
    cdef Doubles S, B, F, Z, values, scale, x, y, r, d, P, way, size
    cdef Indices pivots
