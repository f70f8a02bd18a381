cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.course cimport Events
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t BEGIN, JUMP, MOVE, SETTLE, DONE, NOT_FINITE


cdef class Course(Events):
    cdef Mechanism s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef Py_ssize_t occur(Mechanism s, Record record, Tally tally) noexcept nogil
cdef bint begin(Mechanism s) noexcept nogil
