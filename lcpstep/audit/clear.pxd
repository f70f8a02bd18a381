cimport cython
from lcpstep.audit.cells cimport Cells
from lcpstep.kernels.function cimport Function

cdef Py_ssize_t DEEPEST, MOST
cdef double SLACK, ERRORS, TIMES


cdef class Gap:
    cdef Cells cells
    cdef Function motion, frame
    cdef object kept, stack
    cdef double* q
    cdef double* v
    cdef double* moving
    cdef double* G
    cdef double* times
    cdef double* places
    cdef double* gaps
    cdef double* bends
    cdef double place, bend, fourth, loose, length, error, own, small, since, until, rate, moment, near, negligible
    cdef double begin_place, end_place, begin_gap, end_gap, begin_bend, end_bend
    cdef bint first, last, begin_known, end_known
    cdef void at(self, double tau) noexcept nogil
    cdef void note_ends(
        self, double begin, double end, double begin_gap, double end_gap, double begin_bend, double end_bend
    ) noexcept nogil
    cdef double own_motion(self, Py_ssize_t c, double t) noexcept nogil
    cdef double sigma(self, Py_ssize_t c, double t) noexcept nogil

cdef double late(double t, double speed) noexcept nogil
cdef double same_time(double t) noexcept nogil
@cython.locals(least=double)
cdef bint open_between(
    double g_a, double g_b, double h, double low, double high, double kick, bint first, bint last, double error
) noexcept nogil
cdef bint shallow(Gap g, double g_a, double g_b, double h, double high, double kick) noexcept nogil
cdef double rise(Gap g, Py_ssize_t c, double h, double low, double kick) noexcept nogil
cdef bint beside(Gap g, double a, double b, double time) noexcept nogil
cdef bint near(Gap g, double a, double b) noexcept nogil
@cython.locals(good=bint, begins=bint, ends=bint, first=bint, last=bint, place=double, bend=double, gap=double, kick=double)
cdef bint clear(Gap g, Py_ssize_t c, double t0, double a, double b) noexcept nogil
cdef bint between_corners(
    Gap g, Py_ssize_t c, double t0, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts
) noexcept nogil
