cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, IMPACT, JAM, JUMP, LEANS, NO_IMPULSES, NOT_FINITE, PAINLEVE_INCONSISTENT, OPEN, SLIDES, STICKS, BUFFER_FULL, DONE, TOO_MANY_EVENTS, ROUNDS

cdef Py_ssize_t jump(Rubbing s, Record record, Tally tally, double t) noexcept nogil
cdef bint strike(Rubbing s, Record record, Tally tally, double t, bint plastic) noexcept nogil
cdef void look_before(Rubbing s) noexcept nogil
@cython.locals(found=bint)
cdef bint can_rest(Rubbing s) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) gather(Rubbing s, bint plastic) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) pose(Rubbing s) noexcept nogil
cdef void take_for_none(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint strike_together(Rubbing s, Record record, Tally tally, double t, bint plastic) noexcept nogil
@cython.locals(share=double, own=bint)
cdef bint find_impulses(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f, bint plastic) noexcept nogil
cdef void strike_with(
    Rubbing s, Record record, Tally tally, double t, Py_ssize_t n_a, Py_ssize_t n_f, Py_ssize_t jammed, bint plastic
) noexcept nogil
@cython.locals(done=bint)
cdef Py_ssize_t jam(Rubbing s, Record record, Tally tally, double t) noexcept nogil
cdef void find_free(Rubbing s) noexcept nogil
cdef bint is_free(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void forget_terms(Rubbing s) noexcept nogil
