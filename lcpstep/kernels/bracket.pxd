cdef class Bracket:
    cdef double a, b, x, f, step, seen, value, moved
    cdef bint positive, known
    cdef Py_ssize_t looks
