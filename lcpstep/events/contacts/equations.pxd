cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t LEANS, SLIDES, STICKS

cdef bint measure_rows(Rubbing s, double t, double* y) noexcept nogil
@cython.locals(sticks=bint)
cdef bint measure_friction(Rubbing s, double t, double* y) noexcept nogil
cdef bint measure(Rubbing s, double t, double* y) noexcept nogil
cdef void measure_gaps(Rubbing s, double t, double* y) noexcept nogil
cdef void measure_velocities(Rubbing s, double* v) noexcept nogil
cdef double sliding(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double of_tangent(Rubbing s, double* x, Py_ssize_t c) noexcept nogil
cdef double rounding_of_gap(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double gap_tolerance(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double share_left(Rubbing s) noexcept nogil
cdef double speed_tolerance(Rubbing s, Py_ssize_t i) noexcept nogil
cdef double force_noise(Rubbing s) noexcept nogil
cdef double load_terms(Rubbing s, Py_ssize_t j) noexcept nogil
cdef void apply(Rubbing s, Py_ssize_t i, double p) noexcept nogil
cdef void add_impulse(Rubbing s, Py_ssize_t i, double p) noexcept nogil
cdef bint rubs(Rubbing s, Py_ssize_t c) noexcept nogil
