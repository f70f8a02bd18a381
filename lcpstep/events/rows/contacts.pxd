cimport cython
from lcpstep.events.rows.state cimport Rows
from lcpstep.kernels.coulomb cimport ContactProblem
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t BEGIN, LEANS, OPEN, SLIDES, STICKS
cdef double STILL


cdef class Contacts(Rows):
    cdef object contact_numbers, marks
    cdef public Py_ssize_t next, culprit
    cdef bint mapped
    cdef readonly ContactProblem problem
    cdef Doubles q, v, dv, a, effect, multiplier, gap, velocity, impulse, turn_impulse, turn_velocity, instant, terms, owed
    cdef Doubles before, curve, struck, since, left, chatter_end, mu, mu_s, direction, was_direction
    cdef Indices rough, mode, was_mode, tried, loaded, free, touches, parting
    cdef double noise(self, Py_ssize_t c) noexcept nogil
    cdef double rounding_of_gap(self, Py_ssize_t c) noexcept nogil
    @cython.locals(slides=bint)
    cdef Py_ssize_t mode_closed(self, Py_ssize_t c) noexcept nogil
    cdef void push(self, Py_ssize_t i, double p) noexcept nogil
    cdef void stop(self) noexcept nogil


cdef double gap_of(Contacts s, Py_ssize_t c) noexcept nogil
cdef bint is_met(Contacts s, Py_ssize_t c) noexcept nogil
cdef void add_impulse(Contacts s, Py_ssize_t i, double p) noexcept nogil
cdef void measure_velocities(Contacts s, double* v) noexcept nogil
cdef double gap_tolerance(Contacts s, Py_ssize_t c) noexcept nogil
cdef double speed_tolerance(Contacts s, Py_ssize_t i) noexcept nogil
cdef double still(Contacts s, Py_ssize_t i) noexcept nogil
cdef bint rubs(Contacts s, Py_ssize_t c) noexcept nogil
cdef double sliding(Contacts s, Py_ssize_t c) noexcept nogil
cdef double of_tangent(Contacts s, double* x, Py_ssize_t c) noexcept nogil
cdef double pull(Contacts s, Py_ssize_t i) noexcept nogil
cdef bint leans(Contacts s, Py_ssize_t i) noexcept nogil
cdef bint hold_row(Contacts s, Py_ssize_t i) noexcept nogil
cdef bint hold_modes(Contacts s) noexcept nogil
cdef void hold_leaning(Contacts s) noexcept nogil
cdef void accelerate_on_joints(Contacts s) noexcept nogil
cdef void accelerate_as_held(Contacts s) noexcept nogil
cdef void list_multipliers(Contacts s) noexcept nogil
cdef void list_by_row(Contacts s, double* x, double* out) noexcept nogil
cdef void stop_rows(Contacts s) noexcept nogil
cdef void take_velocities(Contacts s) noexcept nogil
cdef void count_impulses(Contacts s, double* x) noexcept nogil
