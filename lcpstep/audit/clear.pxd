cdef class Gap:
    cdef Cells cells
    cdef Function motion, frame
    cdef object kept, stack
    cdef Doubles q, v, moving, G, times, places, gaps, bends
    cdef double place, bend, fourth, loose, length, error, own, small, since, until, rate, moment, near, negligible
    cdef double begin_place, end_place, begin_gap, end_gap, begin_bend, end_bend
    cdef bint first, last, begin_known, end_known
