cimport cython
from lcpstep.pointers cimport abs, inf, max, min, nan

cdef Py_ssize_t MOST


@cython.final
cdef class Bracket:
    cdef double a, b, x, f, slope, seen, value, step
    cdef bint positive, known
    cdef Py_ssize_t looks
    cdef void begin(self, double a, double b, bint positive, double x) noexcept nogil
    cdef void span(self, double a, double f_a, double b, double f_b) noexcept nogil
    cdef bint seek(self, double small) noexcept nogil
    cdef void take(self, double f, double slope) noexcept nogil
    cdef double chord(self, double f) noexcept nogil
