cimport cython

cdef Py_ssize_t MOST
cdef double LITTLE


@cython.final
cdef class Bracket:
    cdef double a, b, x, f, step, seen, value, moved
    cdef bint positive, known
    cdef Py_ssize_t looks
    cdef void begin(self, double a, double b, bint positive, double x) noexcept nogil
    cdef void span(self, double a, double f_a, double b, double f_b) noexcept nogil
    @cython.locals(inwards=bint, halved=bint)
    cdef bint seek(self, double small) noexcept nogil
    @cython.locals(inwards=bint)
    cdef bint arrive(self, double small) noexcept nogil
    cdef void take(self, double f, double step) noexcept nogil
    cdef void newton(self, double f, double slope) noexcept nogil
    cdef void chord(self, double f) noexcept nogil
