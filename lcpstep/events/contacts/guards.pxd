cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t LEANS, OPEN, SLIDES, STICKS, STAGES, SAMPLES, PARTS, MOST_PARTS, UNKNOWN
cdef double UNSEEN, RESOLVED, LOW, OFF

cdef bint look(Rubbing s, double t, double* y) noexcept nogil
cdef bint look_at_stage(Rubbing s, Py_ssize_t stage, double t, double* y) noexcept nogil
@cython.locals(opened=bint)
cdef bint read(Rubbing s, double t, double* y) noexcept nogil
cdef bint begin_guards(Rubbing s, double t) noexcept nogil
cdef double no_gap(Rubbing s, Py_ssize_t c, double u, double alpha) noexcept nogil
@cython.locals(fine=bint, risen=bint, turns=bint, error=double, most=double, hidden=double, place=double)
cdef Py_ssize_t first_event(Rubbing s, double h) noexcept nogil
@cython.locals(seen=bint)
cdef bint has(Rubbing s, Py_ssize_t g) noexcept nogil
cdef bint stays_clear(Rubbing s, double h) noexcept nogil
cdef void find_bows(Rubbing s, double h) noexcept nogil
cdef double bow(Rubbing s, Py_ssize_t g) noexcept nogil
cdef bint sample(Rubbing s, double h, double a, double b) noexcept nogil
cdef bint look_between(Rubbing s, double place, double t) noexcept nogil
cdef double first_fall(Rubbing s, Py_ssize_t g) noexcept nogil
cdef bint rises(Rubbing s, Py_ssize_t g, double place) noexcept nogil
cdef void arm(Rubbing s) noexcept nogil
