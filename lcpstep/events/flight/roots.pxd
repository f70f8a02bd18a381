cimport cython
from lcpstep.events.flight.motion cimport Flight
from lcpstep.kernels.bracket cimport Bracket

cdef Py_ssize_t GUESSES, POLISHES
cdef double NONE, RESOLUTION, STRAIGHT, COARSE, POLISH, POLISHED

@cython.locals(falling=bint)
cdef double first_contact(Flight s, double a, double b, double g_b, double u_b, double alpha_b) noexcept nogil
cdef double first_in_half(
    Flight s, double a, double g_a, double u_a, double b, double g_b, double u_b
) noexcept nogil
cdef double gap_root(
    Flight s, double a, double g_a, double u_a, double b, double g_b, double u_b
) noexcept nogil
cdef double root(
    Flight s, Py_ssize_t level, double a, double f_a, double b, double f_b, double guess
) noexcept nogil
cdef bint approach(Bracket r, double g, double u, double alpha) noexcept nogil
cdef (double, double, double) polish(Flight s, double tau) noexcept nogil
