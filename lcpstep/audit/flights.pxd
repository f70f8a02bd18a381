cimport cython
from lcpstep.audit.swing cimport Swing
from lcpstep.events.flight.motion cimport Flight

cdef double SLACK, ROUNDING, PRESSING, BEFORE, HALF_TURN, ERRORS
cdef Py_ssize_t UNKNOWN, PRESSED

@cython.locals(whole=bint, good=bint, begins=bint, i=Py_ssize_t, n=Py_ssize_t, n_cuts=Py_ssize_t)
cpdef object clear_flights(
    Swing g, object t, object q, object y, object w, object touched, object kind, object cuts, object found
)
@cython.locals(good=bint, even=bint)
cdef bint at_once(Swing g, Flight o, double t, double* q, double* x, double* w, bint whole) noexcept nogil
cdef double equation(Swing g, Flight o, double t, double y, double w) noexcept nogil
cdef void leave(Swing g, Flight s, double t, double y, double w) noexcept nogil
@cython.locals(good=bint)
cdef bint pressed(Swing g, Flight s, double t0, double a, double b) noexcept nogil
cdef bint pressed_between_corners(
    Swing g, Flight s, double t0, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts
) noexcept nogil
