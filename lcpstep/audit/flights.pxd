cimport cython
from libc.math cimport cos, hypot, sin, sqrt
from lcpstep.arrays cimport doubles, small_numbers
from lcpstep.audit.cells cimport Cells
from lcpstep.audit.clear cimport DEEPEST, MOST, Gap, beside, between_corners, late, open_between, same_time
from lcpstep.events.flight.motion cimport Flight, absolute, leave_from, steady
from lcpstep.pointers cimport abs, after, inf, max, min, nan

cdef double SLACK, ROUNDING, PRESSING, BEFORE, HALF_TURN, ERRORS
cdef Py_ssize_t UNKNOWN, PRESSED, DEEP


@cython.final
cdef class Swing(Gap):
    cdef Flight s
    cdef readonly bint swings, known
    cdef double forced, height, per_root, amplitude, force, force_at, middle, turning, most, bound, fast
    cdef double left, right, begin_above, end_above
    cdef double size(self, double z, double w) noexcept nogil
    cdef void begin(self, double t, double y, double w) noexcept nogil

@cython.locals(whole=bint, good=bint, begins=bint, i=Py_ssize_t, n=Py_ssize_t, n_cuts=Py_ssize_t)
cpdef object clear_flights(
    Swing g, object t, object q, object y, object w, object touched, object kind, object cuts, object found
)
@cython.locals(good=bint)
cdef bint at_once(Swing g, Flight o, double t, double* q, double* x, double* w, bint whole) noexcept nogil
cdef double swung(Swing g, Flight o, double least) noexcept nogil
cdef bint parts_at_ends(
    Swing g, double begin, double end, double rate, double low, double high
) noexcept nogil
@cython.locals(n=Py_ssize_t, x=double, y=double, lowest=double, least=double, slope=double, bent=double)
cdef bint above(Swing g, double t, double high, Py_ssize_t most) noexcept nogil
cdef bint above_at_ends(
    Swing g, Flight o, double t, double y, double y_b, double w, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts
) noexcept nogil
cdef bint smooth(Swing g, double a, double b, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts) noexcept nogil
cdef double equation(Swing g, Flight o, double t, double y, double w) noexcept nogil
cdef void leave(Swing g, Flight s, double t, double y, double w) noexcept nogil
@cython.locals(good=bint)
cdef bint pressed(Swing g, Flight s, double t0, double a, double b) noexcept nogil
cdef bint pressed_between_corners(
    Swing g, Flight s, double t0, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts
) noexcept nogil
cdef (double, double) driven(Flight s, double t) noexcept nogil
