cimport cython
from lcpstep.events.general.equations cimport measure
from lcpstep.events.general.keep cimport keep
from lcpstep.events.general.modes cimport jump, obey, settle
from lcpstep.events.general.motion cimport closed_from
from lcpstep.events.general.parabolas cimport fly
from lcpstep.events.general.state cimport BEGIN, ENTERED, JUMP, JUMPED, LOOKED, MOVE, Mechanism, OBEY, SETTLE
from lcpstep.events.general.step cimport complete, step
from lcpstep.events.general.switching cimport look_at_guards, switch
from lcpstep.kernels.course cimport AHEAD, ARRIVED, DUE, Events
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy

cdef Py_ssize_t DONE, NOT_FINITE


cdef class Course(Events):
    cdef Mechanism s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef Py_ssize_t occur(Mechanism s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t go_further(Mechanism s, Record record, Tally tally) noexcept nogil
cdef bint begin(Mechanism s) noexcept nogil
