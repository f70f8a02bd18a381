from lcpstep.events.friction.held cimport right_hand_side
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.events.friction.step cimport step
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport after


cdef class Smooth(Rubbing):
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef Py_ssize_t proceed(self, Record record, Tally tally) noexcept nogil
