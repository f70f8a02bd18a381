from lcpstep.events.general.earliest cimport NONE
from lcpstep.events.general.equations cimport measure
from lcpstep.events.general.motion cimport closed_from, touching
from lcpstep.events.general.state cimport ENTERED, JUMPED, LOOKED, Mechanism, SWITCH
from lcpstep.events.hybrid.locate cimport UNKNOWN, find, locate
from lcpstep.events.hybrid.loop cimport MAX_STALLED, enter, leave
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport min

cdef Py_ssize_t BUFFER_FULL, DONE, ENDLESS_SWITCHING, INSIDE, NOT_FINITE, NOT_TRANSVERSAL, SWITCHES, TOO_MANY_EVENTS

cdef Py_ssize_t watch(Mechanism s) noexcept nogil
cdef double reach_guard(Mechanism s) noexcept nogil
cdef void look_at_guards(Mechanism s) noexcept nogil
cdef Py_ssize_t switch(Mechanism s, Tally tally) noexcept nogil
cdef Py_ssize_t place(Mechanism s) noexcept nogil
