cdef class Advance:
    cdef object kept, series_of
    cdef readonly double t, g, u
    cdef readonly Py_ssize_t rows, events, steps, next
    cdef Py_ssize_t n, most
    cdef double delta, w2, w_d, F0, Fc, Fs, Omega, s0, X, Y, fast, forced, bound, r, push, A, B, x, y, t0, late, late0
    cdef double t_end, size
    cdef bint resting, begun, series
    cdef Doubles times, states, log, T
