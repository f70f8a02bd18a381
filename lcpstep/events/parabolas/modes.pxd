cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t IMPACT, JUMP, NO_FORCES, NO_IMPULSES, OPEN, SLIDES, BUFFER_FULL, DONE, TOO_MANY_EVENTS, ROUNDS

cdef Py_ssize_t jump(Mechanism s, Record record, Tally tally) noexcept nogil
@cython.locals(rises=bint)
cdef bint just_opened(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(landed=bint, new=bint)
cdef void let_go(Mechanism s) noexcept nogil
@cython.locals(touches=bint)
cdef void rejoin(Mechanism s) noexcept nogil
@cython.locals(hit=bint)
cdef bint approaches(Mechanism s) noexcept nogil
@cython.locals(more=bint, comes=bint)
cdef void find_come(Mechanism s) noexcept nogil
@cython.locals(strikes=bint)
cdef bint has_come(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void tell_impacts(Mechanism s, Record record, Tally tally, double t) noexcept nogil
cdef Py_ssize_t settle(Mechanism s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t forces(Mechanism s) noexcept nogil
