cimport cython
from lcpstep.events.general.equations cimport measure
from lcpstep.events.general.keep cimport keep
from lcpstep.events.general.modes cimport jump, obey, settle
from lcpstep.events.general.motion cimport closed_from
from lcpstep.events.general.parabolas cimport fly
from lcpstep.events.general.state cimport ENTERED, JUMP, JUMPED, LOOKED, MOVE, Mechanism, OBEY, SETTLE, SWITCH
from lcpstep.events.general.step cimport complete, step
from lcpstep.events.general.switching cimport look_at_guards, switch
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy

cdef Py_ssize_t BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS, SLACK

cdef Py_ssize_t released(Mechanism s, Record record, Tally tally, Py_ssize_t goal) noexcept
cdef void put_back(Mechanism s, Record record) noexcept nogil
cdef Py_ssize_t go_on(Mechanism s, Record record, Tally tally, Py_ssize_t goal) noexcept nogil
cdef bint begin(Mechanism s) noexcept nogil
