cimport cython
from lcpstep.audit.swing cimport Swing
from lcpstep.events.flight.motion cimport Flight

cdef double SLACK, ROUNDING, PRESSING, BEFORE, HALF_TURN, ERRORS
cdef Py_ssize_t UNKNOWN, PRESSED

@cython.locals(whole=bint, good=bint, begins=bint, i=Py_ssize_t, n=Py_ssize_t, n_cuts=Py_ssize_t)
cpdef object clear_flights(Swing g, object t, object q, object v, object touched, object kind, object cuts, object found)
@cython.locals(even=bint, plain=bint)
cdef bint at_once(Swing g, Flight o, double t, double t_b, double* q, double* v, bint whole) noexcept nogil
@cython.locals(size=double)
cdef void note_error(Swing g, Flight o, double t, double t_b, double q, double v) noexcept nogil
cdef double lowest_place(Swing g, Flight o, double least) noexcept nogil
cdef void look(Swing g, double t, double t_b) noexcept nogil
@cython.locals(within=double)
cdef bint stays(Swing g, double low, double high, double kick, bint even) noexcept nogil
@cython.locals(kick=double)
cdef bint by_states(Swing g, Flight o, double t, double t_b, double* q, double* v, bint whole) noexcept nogil
@cython.locals(margin=double, low=double, first=bint, last=bint, shallow=bint)
cdef bint by_equation(
    Swing g, Flight o, double t, double t_b, double y, double w, double kick
) noexcept nogil
cdef double equation(Swing g, Flight o, double t, double y, double w) noexcept nogil
cdef void leave(Swing g, Flight s, double t, double y, double w) noexcept nogil
@cython.locals(good=bint)
cdef bint pressed(Swing g, Flight s, double t0, double a, double b) noexcept nogil
cdef bint pressed_between_corners(
    Swing g, Flight s, double t0, double* cuts, Py_ssize_t i, Py_ssize_t n_cuts
) noexcept nogil
