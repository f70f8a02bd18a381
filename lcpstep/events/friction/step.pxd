cimport cython
from libc.math cimport sqrt
from lcpstep.events.friction.equations cimport add_impulse, measure
from lcpstep.events.friction.guards cimport UNKNOWN, first_event
from lcpstep.events.friction.held cimport hold_modes, right_hand_side
from lcpstep.events.friction.impact cimport forget_terms, still
from lcpstep.events.friction.keep cimport keep
from lcpstep.events.friction.modes cimport decide, undecided
from lcpstep.events.friction.moments cimport locate
from lcpstep.events.friction.parting cimport part_before
from lcpstep.events.friction.state cimport GUARDS, Rubbing
from lcpstep.events.friction.surfaces cimport find_touching, lift, project
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport clear, copy
from lcpstep.pointers cimport abs, min

cdef Py_ssize_t ALL, STAGES, SETTLE, JUMP, LEANS, OBEY, OPEN, STICKS, DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, STEP_TOO_SMALL
cdef double LOOK_AHEAD, FURTHER, FARTHEST

cdef Py_ssize_t step(Rubbing s, Record record, Tally tally) noexcept nogil
cdef void change_pace(Rubbing s) noexcept nogil
cdef bint of_force(Rubbing s, Py_ssize_t g) noexcept nogil
cdef Py_ssize_t arrive(Rubbing s, Py_ssize_t g) noexcept nogil
cdef Py_ssize_t look_ahead(Rubbing s, double h) noexcept nogil
cdef void meet(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void stop(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(rests=bint)
cdef void find_standing(Rubbing s) noexcept nogil
cdef void take_over(Rubbing s, Record record, Tally tally, double t, double tau) noexcept nogil
cdef void keep_wanted(Rubbing s, Record record, double tau) noexcept nogil
cdef void press_between(Rubbing s, double a, double b) noexcept nogil
cdef void press_rest(Rubbing s, double a, double b) noexcept nogil
cdef bint sum_up(Rubbing s) noexcept nogil
