cimport cython
from lcpstep.events.flight.motion cimport Flight

cdef Py_ssize_t LEAPS
cdef double SURE, WORTH, BULGE, LEAST_BULGE

@cython.locals(clear=bint, opens=bint)
cdef bint suspect(Flight s, double length, double g, double u, double alpha) noexcept nogil
cdef double hardest(Flight s) noexcept nogil
cdef double clear_until(Flight s, double limit) noexcept nogil
