cimport cython

cdef Py_ssize_t ROUNDS
cdef double NEARER


@cython.final
cdef class Turn:
    cdef double x, lowest, least, low, high, at, h, f_0, f_1, f_2
    cdef Py_ssize_t rounds, sample
    cdef void begin(self, double x, double h, double f_0, double f_1, double f_2) noexcept nogil
    cdef bint seek(self) noexcept nogil
    cdef void take(self, double f) noexcept nogil
