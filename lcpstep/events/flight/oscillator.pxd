cdef double[18] ONE_OVER
cdef double[18] ONE_OVER_PAIR

cdef class Oscillator:
    cdef readonly double delta, w2, f0, X, Y, Omega
