cimport cython
from lcpstep.audit.swing cimport Swing
from lcpstep.events.flight.motion cimport Flight

cdef double SLACK, ROUNDING
cdef Py_ssize_t DEEP

cdef double swung(Swing g, Flight o, double least) noexcept nogil
cdef bint rises(Swing g, double low, double kick) noexcept nogil
cdef bint parts_at_ends(
    Swing g, double begin, double end, double rate, double low, double high
) noexcept nogil
@cython.locals(n=Py_ssize_t, x=double, y=double, lowest=double, least=double, slope=double, bent=double,
               at_x=double, at_y=double)
cdef bint above(Swing g, double t, double high, Py_ssize_t most) noexcept nogil
cdef bint above_at_ends(Swing g, Flight o, double t, double y, double y_b, double w) noexcept nogil
cdef bint smooth(Swing g, double a, double b) noexcept nogil
