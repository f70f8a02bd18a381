from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t BUFFER_FULL, DONE, ENDLESS_SWITCHING, INSIDE, NOT_FINITE, NOT_TRANSVERSAL, SWITCHES, TOO_MANY_EVENTS

cdef Py_ssize_t watch(Mechanism s) noexcept nogil
cdef double reach_guard(Mechanism s) noexcept nogil
cdef void look_at_guards(Mechanism s) noexcept nogil
cdef Py_ssize_t switch(Mechanism s, Tally tally) noexcept nogil
cdef Py_ssize_t place(Mechanism s) noexcept nogil
