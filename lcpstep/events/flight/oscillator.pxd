from lcpstep.kernels.model cimport Model

cdef Py_ssize_t TERMS, k
cdef double SMALL, NEGLIGIBLE, NOTHING, NEAR_RESONANCE
cdef double D1, D2, D3, D4, D5, D6, D7, C1, C2, C3, C4, C5, C6, C7
cdef double[18] ONE_OVER
cdef double[18] ONE_OVER_PAIR


cdef class Oscillator:
    cdef readonly double delta, w2, f0, X, Y, Omega

cpdef object oscillator_of(Model m)
cdef double envelope(double delta, double w2, double x, double dx) noexcept nogil
cpdef (double, double, double) fundamental(double delta, double w2, double tau) noexcept nogil
cdef (double, double, double) undamped_series(double w2, double tau) noexcept nogil
cdef (double, double, double) series(double delta, double w2, double tau) noexcept nogil
cdef (double, double, double) overdamped(double delta, double w2, double tau) noexcept nogil
