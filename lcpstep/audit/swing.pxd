cimport cython
from lcpstep.audit.clear cimport Gap
from lcpstep.events.flight.motion cimport Flight

cdef double SLACK


@cython.final
cdef class Swing(Gap):
    cdef Flight s
    cdef readonly bint swings, known
    cdef double forced, height, per_root, amplitude, force, force_at, middle, turning, most, bound, fast
    cdef double left, right, begin_above, end_above
    cdef double size(self, double z, double w) noexcept nogil
    cdef void begin(self, double t, double y, double w) noexcept nogil

cdef (double, double) driven(Flight s, double t) noexcept nogil
