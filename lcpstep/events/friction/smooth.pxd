from lcpstep.events.friction.held cimport right_hand_side
from lcpstep.events.friction.state cimport Rubbing


cdef class Smooth(Rubbing):
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
