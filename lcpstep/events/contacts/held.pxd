cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef bint hold_modes_again(Rubbing s) noexcept nogil
cdef bint right_hand_side(Rubbing s, double t, double* y, double* dy) noexcept nogil
cdef bint know_rows(Rubbing s, double t, double* y, double* dy) noexcept nogil
cdef void accelerate(Rubbing s, double t, double* y, double* a) noexcept nogil
cdef void map_forces(Rubbing s) noexcept nogil
