cimport cython
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.course cimport Course

cdef Py_ssize_t BUFFER_FULL, DONE, ENDLESS_SWITCHING, NOT_FINITE, NOT_TRANSVERSAL, STEP_TOO_SMALL, TOO_MANY_EVENTS
cdef Py_ssize_t MAX_STALLED, NEVER_LEFT


cdef class Switching(Course):
    cdef Motion s
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t refusal(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef Py_ssize_t advance(Motion s) noexcept nogil
cdef Py_ssize_t settle(Motion s, Py_ssize_t k) noexcept nogil
cdef Py_ssize_t switch(Motion s, Py_ssize_t k) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) target_of(Motion s, Py_ssize_t k) noexcept nogil
cdef Py_ssize_t leave(Motion s, Py_ssize_t k) noexcept nogil
@cython.locals(passed=bint, may_act=bint)
cdef Py_ssize_t enter(Motion s, Py_ssize_t left, bint jumped) noexcept nogil
