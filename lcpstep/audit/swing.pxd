cdef class Swing(Gap):
    cdef Flight s
    cdef readonly bint swings, known, alone
    cdef double forced, height, per_root, amplitude, middle, turning, most, bound, damped, root, fast, low, high, met
    cdef double left, right, begin_above, end_above
    cdef double y, w, wave_at, cosine, sine, frame_at, shift, drag
