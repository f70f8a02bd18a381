cimport cython
from lcpstep.events.flight.motion cimport Flight

cdef Py_ssize_t ACCUMULATION, IMPACT, RELEASE, STICK
cdef double CLOSED, FREE, NONE, ON_THE_SURFACE, UNSEEN, JUMP

cdef void log(Flight s, double t, Py_ssize_t kind, double before, double after, double p) noexcept nogil
cdef bint sticks(double u, double alpha, double t) noexcept nogil
cdef void impact(Flight s, double u) noexcept nogil
cdef void settle(Flight s, double u) noexcept nogil
cdef double chatter_left(Flight s, double u, double alpha) noexcept nogil
cdef void go_on(Flight s, double t, double g, double u) noexcept nogil
cdef void stick(Flight s, double t_log) noexcept nogil
cdef void settle_again(Flight s) noexcept nogil
cdef void release(Flight s, double alpha) noexcept nogil
@cython.locals(strikes=bint)
cdef void turn_corner(Flight s) noexcept nogil
cdef double pass_corner(Flight s, double t) noexcept nogil
