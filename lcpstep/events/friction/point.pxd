from lcpstep.arrays cimport doubles
from lcpstep.events.friction.equations cimport free_motion, measure, measure_rows
from lcpstep.events.friction.guards cimport look
from lcpstep.events.friction.held cimport hold_modes, pull, right_hand_side
from lcpstep.events.friction.impact cimport find_free
from lcpstep.events.friction.modes cimport decide, adopt_modes
from lcpstep.events.friction.state cimport GUARDS, Rubbing
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, after, max, whole

cdef Py_ssize_t OPEN, SLIDES, DONE, NOT_FINITE
cdef double RELATIVE_STEP

cdef void read_modes(Rubbing s, double* mode, double* direction) noexcept nogil
cdef Py_ssize_t find_modes(Rubbing s, double t, double* y, double* closed) noexcept nogil
cdef bint begin_modes(Rubbing s, double t, double* y, double* mode, double* direction) noexcept nogil
cdef void difference(Rubbing s, double t, double* y, double* dy, double* A) noexcept nogil
cdef void write_guards(Rubbing s, double t, double* y, double* out) noexcept nogil
cdef void write_forces(Rubbing s, double t, double* y, double* dy, double* out) noexcept nogil
cdef void write_pulls(Rubbing s, double* out) noexcept nogil
cdef void write_rows(Rubbing s, double t, double* y, double* out) noexcept nogil
