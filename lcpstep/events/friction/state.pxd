from lcpstep.events.hybrid.roots cimport Scan
from lcpstep.kernels.clock cimport Clock
from lcpstep.kernels.coefficients cimport Coefficients
from lcpstep.kernels.coulomb cimport ContactProblem
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.rungekutta cimport RungeKutta
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ALL, GUARDS, BEGIN, NOT_FINITE
cdef double NOISE


cdef class Rubbing(RungeKutta):
    cdef object turn, rule, table, per_contact, given, marks, looks, arms
    cdef readonly Model contacts, joints, tangents
    cdef readonly Clock clock
    cdef readonly ContactProblem problem
    cdef readonly Coefficients coefficients
    cdef Scan scan
    cdef readonly Py_ssize_t n_q, n_c, n_j, n_r, n_held, n_nodes
    cdef public Py_ssize_t next, culprit, jams, rounds
    cdef readonly bint in_turn, yields
    cdef readonly double t_end, scan_length
    cdef Py_ssize_t guard, paced
    cdef double found, slope
    cdef bint constant, moving, plain, measured, mapped, risen
    cdef double* nodes
    cdef double* weights
    cdef double* q
    cdef double* v
    cdef double* a_free
    cdef double* a
    cdef double* force
    cdef double* work
    cdef double* shifted
    cdef double* dy
    cdef double* seen
    cdef double* dv
    cdef double* M
    cdef double* R
    cdef double* MR
    cdef double* G
    cdef double* W
    cdef double* S
    cdef double* L
    cdef double* rate
    cdef double* bias
    cdef double* gap
    cdef double* velocity
    cdef double* x
    cdef double* change
    cdef double* multiplier
    cdef double* impulse
    cdef double* account
    cdef double* instant
    cdef double* paces
    cdef double* turn_velocity
    cdef double* turn_start
    cdef double* turn_impulse
    cdef double* shifted_rate
    cdef double* counted
    cdef double* total
    cdef double* loads
    cdef double* doubt
    cdef double* effect
    cdef double* effects
    cdef double* mu
    cdef double* mu_s
    cdef double* slip
    cdef double* tangential
    cdef double* direction
    cdef double* was_direction
    cdef double* new_direction
    cdef double* terms
    cdef double* before
    cdef double* owed
    cdef Py_ssize_t* mode
    cdef Py_ssize_t* was_mode
    cdef Py_ssize_t* new_mode
    cdef Py_ssize_t* loaded
    cdef Py_ssize_t* new_loaded
    cdef Py_ssize_t* free
    cdef Py_ssize_t* touches
    cdef Py_ssize_t* parting
    cdef Py_ssize_t* held
    cdef double* value
    cdef double* band
    cdef double* samples
    cdef Py_ssize_t* armed
    cdef Py_ssize_t proceed(self, Record record, Tally tally) noexcept nogil
