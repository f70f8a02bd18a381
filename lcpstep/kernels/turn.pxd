cdef class Turn:
    cdef double x, lowest, least, low, high, at, h, f_0, f_1, f_2
    cdef Py_ssize_t rounds, sample
