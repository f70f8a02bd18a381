cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.course cimport Events
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t BUFFER_FULL, BEGIN, ENTERED, JUMPED, LOOKED, SETTLE, SWITCH, JUMP, MOVE, OPEN, SLIDES, STAYS_CLOSED, DONE, JOINTS_FAILED, NO_FORCES, NOT_FINITE, PAINLEVE_INCONSISTENT
cdef double LOOK_AHEAD, FURTHER, NO_TIME


cdef class Course(Events):
    cdef Rubbing s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


@cython.locals(settles=bint)
cdef Py_ssize_t occur(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t yielding(Rubbing s, Record record, Tally tally, Py_ssize_t code) noexcept nogil
cdef Py_ssize_t begin(Rubbing s) noexcept nogil
cdef Py_ssize_t turn_corner(Rubbing s) noexcept nogil
cdef Py_ssize_t settle(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t go_further(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t progress(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t seek_modes(Rubbing s, Record record, Tally tally, double t) noexcept nogil
@cython.locals(open_question=bint)
cdef Py_ssize_t look_on(Rubbing s, double t, double longest) noexcept nogil
@cython.locals(some=bint)
cdef bint lets_go(Rubbing s) noexcept nogil
cdef void keep_modes(Rubbing s) noexcept nogil
cdef void tell_left(Rubbing s, Record record, Tally tally, double t) noexcept nogil
cdef Py_ssize_t follow(Rubbing s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t set_out(Rubbing s, Record record, double t) noexcept nogil
