cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, OPEN, SLIDES
cdef double CHECKED

@cython.locals(some=bint)
cdef bint close_small(Rubbing s, Record record, Tally tally, double t) noexcept nogil
@cython.locals(pull=double, most=double)
cdef bint rests(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void join(Rubbing s) noexcept nogil
@cython.locals(slow=bint, low=bint)
cdef double time_left(Rubbing s, Py_ssize_t c, double t) noexcept nogil
cdef double later(Rubbing s, Py_ssize_t c, double t, double T) noexcept nogil
@cython.locals(passed_on=bint)
cdef bint interrupted(Rubbing s, Py_ssize_t c, double T) noexcept nogil
@cython.locals(passed_on=bint, slip=double, stops=bint)
cdef bint stops_others(Rubbing s, Py_ssize_t c, double T) noexcept nogil
cdef double gap_of(Rubbing s, Py_ssize_t d) noexcept nogil
@cython.locals(rubbed=bint)
cdef bint meets(Rubbing s, Py_ssize_t c, Py_ssize_t k) noexcept nogil
@cython.locals(found=bint)
cdef bint passes_on(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void take_along(Rubbing s) noexcept nogil
@cython.locals(fast=bint)
cdef bint awaits(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint is_told(Rubbing s, Py_ssize_t d) noexcept nogil
cdef bint alternates(Rubbing s, Py_ssize_t c, Py_ssize_t d) noexcept nogil
@cython.locals(found=bint)
cdef bint disturbs(Rubbing s) noexcept nogil
@cython.locals(held=bint, pulls=bint, opened=bint)
cdef bint let_go_pulling(Rubbing s) noexcept nogil
@cython.locals(low=bint)
cdef bint throws_off(Rubbing s) noexcept nogil
cdef bint drives_others(Rubbing s) noexcept nogil
