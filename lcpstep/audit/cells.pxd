cdef class Cells:
    cdef object arrays, bounds
    cdef readonly bint given, rough, whole_rough
    cdef readonly Py_ssize_t n, n_c
    cdef Py_ssize_t here, n_bins
    cdef object starts
    cdef Indices bins
    cdef readonly double period, length
    cdef double per, turn
    cdef Doubles ends, levels, whole_top, whole_low, whole_high, whole_fast, whole_bottom, whole_size, whole_kick
    cdef readonly double bottom, top, slow, low, high, kick
