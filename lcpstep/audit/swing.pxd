cimport cython
from lcpstep.audit.clear cimport Gap
from lcpstep.events.flight.motion cimport Flight

cdef double SLACK


@cython.final
cdef class Swing(Gap):
    cdef Flight s
    cdef readonly bint swings, known, alone
    cdef double forced, height, per_root, amplitude, middle, turning, most, bound, damped, root, fast, low, high, met
    cdef double left, right, begin_above, end_above
    cdef double y, w, wave_at, cosine, sine, frame_at, shift, drag
    cdef void stand(self, double t, double q, double v) noexcept nogil
    cdef void begin(self, double t, double q, double v) noexcept nogil

cdef void turn(Swing g, double t) noexcept nogil
cdef (double, double) driven(Swing g, double t) noexcept nogil
