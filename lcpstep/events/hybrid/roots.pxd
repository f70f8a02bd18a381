cimport cython
from lcpstep.kernels.bracket cimport Bracket
from lcpstep.pointers cimport Doubles

cdef Py_ssize_t DEGREE, DEPTH, CHECKS
cdef double NONE


@cython.final
cdef class Scan:
    cdef object arrays
    cdef Bracket bracket
    cdef Doubles points, to_bernstein, at_checks, sample, c, half, stack, low, high


cdef double convert(Scan scan) noexcept nogil
cdef (double, double, double) taylor(double* d, double s, double* work) noexcept nogil
@cython.locals(changes=Py_ssize_t)
cdef double first_rise(Scan scan, double sign, double level, double start) noexcept nogil
cdef double single_root(Bracket r, double* d, double* work) noexcept nogil
