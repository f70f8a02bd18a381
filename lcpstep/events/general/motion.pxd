cimport cython
from lcpstep.events.general.state cimport Mechanism

cdef double SURE, GONE

cdef void rebase(Mechanism s, double t) noexcept nogil
cdef void state_at(Mechanism s, double tau) noexcept nogil
cdef bint come_to_rest(Mechanism s) noexcept nogil
cdef void lift(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void close_with(Mechanism s, Py_ssize_t c) noexcept nogil
cdef bint arrive(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void lift_by(Mechanism s, Py_ssize_t c, double g) noexcept nogil
@cython.locals(downwards=bint)
cdef bint has_room(Mechanism s, Py_ssize_t c, double g) noexcept nogil
cdef double touching(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(still=bint)
cdef double closed_from(Mechanism s, Py_ssize_t c) noexcept nogil
cdef double rounding_of_gap(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void press(Mechanism s, double tau) noexcept nogil
cdef void press_between(Mechanism s, double a, double b) noexcept nogil
