cimport cython


cdef Py_ssize_t IMPACT, ACCUMULATION, STICK, RELEASE, DONE, BUFFER_FULL, STEP_TOO_SMALL, DEGREE, MOST, COLUMNS
cdef double SHORT, BEGIN, LOW, SOON, TOUCH, EPS, TINY, ROUNDING


@cython.final
cdef class Advance:
    cdef object kept, series_of
    cdef readonly double t, g, u
    cdef readonly Py_ssize_t rows, events, steps, next
    cdef Py_ssize_t n, most
    cdef double delta, w2, w_d, F0, Fc, Fs, Omega, s0, X, Y, fast, forced, bound, r, push, A, B, x, y, t0, late, late0
    cdef double t_end, size
    cdef bint resting, begun, series
    cdef double* times
    cdef double* states
    cdef double* log
    cdef double* T
    cdef int follow(self) noexcept nogil
    cdef double force(self, double t) noexcept nogil
    cdef void leave(self) noexcept nogil
    cdef void at(self, double tau) noexcept nogil
    cdef void by_series(self, double tau) noexcept nogil
    cdef bint fly(self) noexcept nogil
    cdef void land(self, double tau) noexcept nogil
    cdef void go_to(self, double tau) noexcept nogil
    cdef void strike(self) noexcept nogil
    cdef void rest(self) noexcept nogil
    cdef void wait(self) noexcept nogil
    cdef void tell(self, double until) noexcept nogil
    cdef void note(self, double before, double following, double impulse, Py_ssize_t kind) noexcept nogil
