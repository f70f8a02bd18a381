cdef class Graph:
    cdef object kept
    cdef Py_ssize_t n, leaves
    cdef readonly double size
    cdef Doubles x, y, boxes
