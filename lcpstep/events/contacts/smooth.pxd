from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally


cdef class Smooth(Rubbing):
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double rate_terms(self) noexcept nogil
    cdef Py_ssize_t proceed(self, Record record, Tally tally) noexcept nogil
    cdef Py_ssize_t straying_at(self, double place, double h, double level) noexcept nogil
