cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t SETTLE, JUMP, LEANS, OBEY, OPEN, SLIDES, STICKS, SWITCH, DONE, NOT_FINITE, NO_FORCES, NO_SURFACE, PAINLEVE_INCONSISTENT
cdef double EDGE, LOOK_AHEAD, FURTHER, FARTHEST, LONGEST

cdef Py_ssize_t step(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t stride(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t find(Rubbing s, double h) noexcept nogil
cdef Py_ssize_t complete(Rubbing s, Record record, Tally tally, double h) noexcept nogil
cdef Py_ssize_t complete_to_event(Rubbing s, Record record, Tally tally, double h) noexcept nogil
cdef Py_ssize_t complete_to_guard(Rubbing s, Record record, Tally tally, double h) noexcept nogil
cdef bint is_landing(Rubbing s, Py_ssize_t g) noexcept nogil
cdef double land(Rubbing s, Py_ssize_t g, double longest) noexcept nogil
cdef void mark_resting(Rubbing s) noexcept nogil
cdef void change_pace(Rubbing s) noexcept nogil
cdef bint of_force(Rubbing s, Py_ssize_t g) noexcept nogil
cdef Py_ssize_t arrive(Rubbing s, Py_ssize_t g) noexcept nogil
@cython.locals(some=bint)
cdef bint changes(Rubbing s) noexcept nogil
@cython.locals(some=bint)
cdef bint differ(Rubbing s) noexcept nogil
cdef Py_ssize_t look_ahead(Rubbing s, double h) noexcept nogil
cdef Py_ssize_t meet(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void stop(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(lies=bint)
cdef void land_with(Rubbing s) noexcept nogil
cdef void stop_with(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(rests=bint)
cdef void find_standing(Rubbing s) noexcept nogil
