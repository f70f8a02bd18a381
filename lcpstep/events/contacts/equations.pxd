cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t LEANS, SLIDES, STICKS

cdef bint measure_rows(Rubbing s, double t, double* y) noexcept nogil
@cython.locals(sticks=bint)
cdef bint measure_friction(Rubbing s, double t, double* y) noexcept nogil
cdef bint measure(Rubbing s, double t, double* y) noexcept nogil
cdef void measure_gaps(Rubbing s, double t, double* y) noexcept nogil
cdef double share_left(Rubbing s) noexcept nogil
cdef double force_noise(Rubbing s) noexcept nogil
cdef double load_terms(Rubbing s, Py_ssize_t j) noexcept nogil
