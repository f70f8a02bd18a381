cimport cython
from lcpstep.pointers cimport Doubles, Indices

cdef double SLACK
cdef Py_ssize_t BINS


@cython.final
cdef class Cells:
    cdef object arrays, bounds
    cdef readonly bint given, rough, whole_rough
    cdef readonly Py_ssize_t n, n_c
    cdef Py_ssize_t here, n_bins
    cdef object starts
    cdef Indices bins
    cdef readonly double period
    cdef double per
    cdef Doubles ends, lo, hi
    cdef unsigned char* branched
    cdef Doubles whole_top, whole_low, whole_high, whole_fast, whole_bottom, whole_size
    cdef readonly double bottom, top, slow, low, high
    cdef void find(self, Py_ssize_t c, double a, double b) noexcept nogil
    @cython.locals(i=Py_ssize_t, low=Py_ssize_t, high=Py_ssize_t, middle=Py_ssize_t)
    cdef Py_ssize_t cell(self, double t) noexcept nogil
