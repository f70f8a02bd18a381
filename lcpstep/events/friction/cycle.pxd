cimport cython
from lcpstep.events.friction.equations cimport apply, measure_velocities
from lcpstep.events.friction.held cimport hold_joints, hold_modes, stop_rows
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.recurrence cimport CERTAIN, FOR_EVER, left, proportion
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, after

cdef Py_ssize_t ACCUMULATION, OPEN, SLIDES, STICKS

cdef void look_back(Rubbing s) noexcept nogil
cdef double recurs(Rubbing s) noexcept nogil
cdef bint rubs_on(Rubbing s, Py_ssize_t i, double ratio) noexcept nogil
cdef bint rests(Rubbing s, Py_ssize_t i, double ratio) noexcept nogil
@cython.locals(rough=bint)
cdef void sum_up(Rubbing s, Record record, Tally tally, double t, double ratio) noexcept nogil
