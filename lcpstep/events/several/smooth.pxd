from lcpstep.events.several.held cimport right_hand_side
from lcpstep.events.several.state cimport Mechanism
from lcpstep.kernels.rungekutta cimport RungeKutta


cdef class Smooth(RungeKutta):
    cdef public Mechanism mechanism
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
