cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION

@cython.locals(moved=bint, some=bint, touches=bint)
cdef bint close_chatter(Mechanism s, Record record, Tally tally) noexcept nogil
cdef void find_stop(Mechanism s) noexcept nogil
cdef void stop(Mechanism s) noexcept nogil
@cython.locals(pulls=bint, opened=bint)
cdef void let_go_pulling(Mechanism s) noexcept nogil
@cython.locals(low=bint)
cdef bint throws_off(Mechanism s) noexcept nogil
cdef bint drives_others(Mechanism s) noexcept nogil
cdef void owe(Mechanism s) noexcept nogil
cdef void hand_on(Mechanism s) noexcept nogil
@cython.locals(low=bint, slow=bint)
cdef double chatter_left(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void take_along(Mechanism s) noexcept nogil
@cython.locals(fast=bint)
cdef bint awaits(Mechanism s, Py_ssize_t c) noexcept nogil
cdef bint is_told(Mechanism s, Py_ssize_t d) noexcept nogil
@cython.locals(free=bint)
cdef bint alternates(Mechanism s, Py_ssize_t c, Py_ssize_t d) noexcept nogil
@cython.locals(held=bint)
cdef bint passes_on(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(passed_on=bint)
cdef bint interrupted(Mechanism s, Py_ssize_t c, double T) noexcept nogil
