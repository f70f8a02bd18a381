cimport cython
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ALL, STAGES, SETTLE, JUMP, LEANS, OBEY, OPEN, STICKS, DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, STEP_TOO_SMALL
cdef double EDGE, LOOK_AHEAD, FURTHER, FARTHEST

cdef Py_ssize_t step(Rubbing s, Record record, Tally tally) noexcept nogil
cdef void mark_resting(Rubbing s) noexcept nogil
cdef void change_pace(Rubbing s) noexcept nogil
cdef bint of_force(Rubbing s, Py_ssize_t g) noexcept nogil
cdef Py_ssize_t arrive(Rubbing s, Py_ssize_t g) noexcept nogil
@cython.locals(some=bint)
cdef bint changes(Rubbing s) noexcept nogil
cdef Py_ssize_t look_ahead(Rubbing s, double h) noexcept nogil
cdef void meet(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void stop(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void stop_with(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(rests=bint)
cdef void find_standing(Rubbing s) noexcept nogil
cdef void take_over(Rubbing s, Record record, Tally tally, double t, double tau) noexcept nogil
cdef void keep_wanted(Rubbing s, Record record, double tau) noexcept nogil
cdef void press_between(Rubbing s, double a, double b) noexcept nogil
cdef void press_rest(Rubbing s, double a, double b) noexcept nogil
cdef bint sum_up(Rubbing s) noexcept nogil
