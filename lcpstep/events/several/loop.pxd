from lcpstep.events.several.equations cimport measure
from lcpstep.events.several.keep cimport keep
from lcpstep.events.several.modes cimport jump, obey, settle
from lcpstep.events.several.motion cimport touching
from lcpstep.events.several.parabolas cimport fly
from lcpstep.events.several.state cimport JUMP, MOVE, Mechanism, OBEY, SETTLE
from lcpstep.events.several.step cimport complete, step
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy

cdef Py_ssize_t BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS, SLACK

cdef Py_ssize_t released(Mechanism s, Record record, Tally tally, Py_ssize_t goal) noexcept
cdef void put_back(Mechanism s, Record record) noexcept nogil
cdef Py_ssize_t go_on(Mechanism s, Record record, Tally tally, Py_ssize_t goal) noexcept nogil
cdef bint begin(Mechanism s) noexcept nogil
