cimport cython
from lcpstep.events.general.state cimport Mechanism

cdef Py_ssize_t MEETS, LANDS, OPENS, NEVER_LEFT, GAP, SPEED, CURVE, MULTIPLIER
cdef double NONE, NEVER, UNSEEN, FALLS

@cython.locals(end=double)
cdef double first_event(Mechanism s, double a, double b) noexcept nogil
cdef bint falls(Mechanism s, Py_ssize_t c, double left, double right, double noise) noexcept nogil
cdef (double, double) lowest(
    Mechanism s, Py_ssize_t c, double a, double b, double left, double right, double noise
) noexcept nogil
cdef double opening(Mechanism s, Py_ssize_t c, double a, double b, double left, double right) noexcept nogil
cdef double first_contact(
    Mechanism s, Py_ssize_t c, double a, double b, (double, double, double) left, (double, double, double) right
) noexcept nogil
cdef double first_in_half(
    Mechanism s, Py_ssize_t c, double a, double b, (double, double, double) left, (double, double, double) right
) noexcept nogil
cdef double root(
    Mechanism s, Py_ssize_t level, Py_ssize_t c, double a, double f_a, double b, double f_b
) noexcept nogil
@cython.locals(known=bint)
cdef bint observe(Mechanism s, double tau) noexcept nogil
cdef double multiplier_noise(Mechanism s) noexcept nogil
cdef bint turns_unseen(Mechanism s, double d) noexcept nogil
cdef double gap_noise(Mechanism s, Py_ssize_t c) noexcept nogil
