from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.stepping.rubbing.strides cimport Strides


cdef class RubbingSteps(Strides):
    cdef Py_ssize_t proceed(self, Record record, Tally tally) noexcept nogil
    cdef Py_ssize_t straying_at(self, double place, double h, double level) noexcept nogil
