cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t LEANS, STICKS, SLIDES

cdef double pull(Rubbing s, Py_ssize_t i) noexcept nogil
cdef bint hold_row(Rubbing s, Py_ssize_t i) noexcept nogil
cdef bint leans(Rubbing s, Py_ssize_t i) noexcept nogil
cdef void accelerate_on_joints(Rubbing s) noexcept nogil
cdef void accelerate_as_held(Rubbing s) noexcept nogil
cdef bint hold_modes(Rubbing s) noexcept nogil
cdef bint hold_modes_again(Rubbing s) noexcept nogil
cdef void hold_leaning(Rubbing s) noexcept nogil
cdef bint right_hand_side(Rubbing s, double t, double* y, double* dy) noexcept nogil
cdef bint know_rows(Rubbing s, double t, double* y, double* dy) noexcept nogil
cdef void accelerate(Rubbing s, double t, double* y, double* a) noexcept nogil
cdef void map_forces(Rubbing s) noexcept nogil
cdef void list_multipliers(Rubbing s) noexcept nogil
cdef void stop_rows(Rubbing s) noexcept nogil
cdef void take_velocities(Rubbing s) noexcept nogil
cdef void count_impulses(Rubbing s, double* x) noexcept nogil
