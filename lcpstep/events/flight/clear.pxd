cimport cython
from libc.math cimport sqrt
from lcpstep.events.flight.motion cimport Flight, absolute
from lcpstep.pointers cimport abs, inf, max, min

cdef Py_ssize_t LEAPS
cdef double SURE, WORTH, BULGE, LEAST_BULGE

@cython.locals(clear=bint, opens=bint)
cdef bint suspect(Flight s, double length, double g, double u, double alpha) noexcept nogil
cdef double hardest(Flight s) noexcept nogil
cdef double clear_until(Flight s, double limit) noexcept nogil
