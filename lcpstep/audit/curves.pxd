cdef class Curve(Gap):
    cdef readonly Py_ssize_t degree
    cdef object space
    cdef Doubles x, second, part
