cimport cython

cdef double SLACK
cdef Py_ssize_t BINS, NEXT, KINDS


@cython.final
cdef class Cells:
    cdef object arrays, bounds
    cdef readonly bint given, rough, whole_rough
    cdef readonly Py_ssize_t n, n_c
    cdef Py_ssize_t here, n_bins
    cdef object starts
    cdef Py_ssize_t* bins
    cdef readonly double period, length
    cdef double per, turn
    cdef double* ends
    cdef double* levels
    cdef double* whole_top
    cdef double* whole_low
    cdef double* whole_high
    cdef double* whole_fast
    cdef double* whole_bottom
    cdef double* whole_size
    cdef double* whole_kick
    cdef readonly double bottom, top, slow, low, high, kick
    cdef void find(self, Py_ssize_t c, double a, double b) noexcept nogil
    @cython.locals(low=Py_ssize_t, high=Py_ssize_t, middle=Py_ssize_t)
    cdef Py_ssize_t cell(self, double t, Py_ssize_t i) noexcept nogil

@cython.locals(n=Py_ssize_t, row=Py_ssize_t, level=Py_ssize_t, levels=Py_ssize_t)
cdef object together(object own)
cdef void fill_level(double* x, double* y, Py_ssize_t n, Py_ssize_t row, Py_ssize_t step) noexcept nogil
