from lcpstep.events.general.held cimport right_hand_side
from lcpstep.events.general.state cimport Mechanism
from lcpstep.events.general.step cimport missed
from lcpstep.events.general.switching cimport SWITCHES
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.rungekutta cimport RungeKutta


cdef class Smooth(RungeKutta):
    cdef public Mechanism mechanism
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil


cdef class Watched(Motion):
    cdef public Mechanism mechanism
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil
