cdef class Switches:
    cdef object kept
    cdef readonly Py_ssize_t n_q, n_c, n
    cdef double creep
    cdef Doubles force, impulse, mobility, response, turned, apart, drop, held_W
    cdef Indices holds, held
