cimport cython
from lcpstep.events.flight.motion cimport Flight

cdef Py_ssize_t PASSES
cdef double NONE, RESOLUTION, SHORT, LOW, SETTLED, LONGER, N1, N2, N3

cdef (double, double) hop_end(Flight s, double a, double b) noexcept nogil
cdef double stretch(Flight s) noexcept nogil
cdef bint is_low(Flight s, double a) noexcept nogil
cdef (double, double, double) fit(Flight s, double h) noexcept nogil
cdef double along(Flight s, Py_ssize_t level, double h, double sigma) noexcept nogil
cdef double turn(Flight s, Py_ssize_t level, double h, double a, double b) noexcept nogil
cdef double first_fall(Flight s, double h) noexcept nogil
cdef (double, double) low_end(Flight s, double h) noexcept nogil
cdef (double, double) short_hop(Flight s, double guess, double longest) noexcept nogil
