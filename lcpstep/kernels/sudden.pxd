cimport cython

cdef double MORE, PLACES, SHARE, SUDDEN


@cython.final
cdef class Sudden:
    cdef bint narrow
    cdef double h, low, high, before, later, middle, whole, x, drift
    cdef void begin(self, double h, double before, double later) noexcept nogil
    @cython.locals(narrow=bint)
    cdef bint seek(self, double t) noexcept nogil
    cdef void take(self, double f) noexcept nogil
    cdef double untold(self, double t) noexcept nogil
    cdef double just_before(self, double t, double coarse) noexcept nogil
    cdef bint is_turn(self) noexcept nogil
    cdef bint is_jump(self) noexcept nogil
    cdef void excuse(self, double u) noexcept nogil


@cython.locals(speed=double)
cdef double coarseness(double* q, double* v, Py_ssize_t n) noexcept nogil
