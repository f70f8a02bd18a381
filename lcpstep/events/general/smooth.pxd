from lcpstep.events.general.state cimport Mechanism
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.rungekutta cimport RungeKutta


cdef class Smooth(RungeKutta):
    cdef public Mechanism mechanism
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double rate_terms(self) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil


cdef class Watched(Motion):
    cdef public Mechanism mechanism
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double rate_terms(self) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil
