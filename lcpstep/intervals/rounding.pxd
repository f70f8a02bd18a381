from libc.math cimport ceil, floor

from lcpstep.pointers cimport abs, inf, max, min

cdef double OUT, TINY, TURN

cdef double below(double x, double units) noexcept nogil
cdef double above(double x, double units) noexcept nogil
