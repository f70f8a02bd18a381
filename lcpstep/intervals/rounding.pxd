cdef double OUT, TINY, TURN

cdef double below(double x, double units) noexcept nogil
cdef double above(double x, double units) noexcept nogil
