cimport cython
from lcpstep.arrays cimport doubles, indices
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport copy, copy_indices, distance, largest
from lcpstep.pointers cimport abs, after, inf, max, min
from lcpstep.stepping.hidden_switches cimport Switches
from lcpstep.stepping.step_control cimport LEAST_SHARE, Control, stamp
from lcpstep.stepping.theta_method.moving cimport Rows, State
from lcpstep.stepping.theta_method.plan cimport Plan
from lcpstep.stepping.theta_method.theta_loop cimport Steps

cdef Py_ssize_t LEVELS, FINISHED, BUFFER_FULL, SAVED
cdef double LATE


cdef class Attempts(Control):
    cdef Steps way
    cdef Model m
    cdef Plan plan
    cdef State s
    cdef Rows rows
    cdef Switches switches
    cdef object kept
    cdef bint struck
    cdef double share
    cdef double* times
    cdef Py_ssize_t steps_before, row, event, asked
    cdef double* q
    cdef double* v
    cdef double* force
    cdef double* one_q
    cdef double* one_v
    cdef double* part_q
    cdef double* part_v
    cdef double* between_q
    cdef double* between_v
    cdef double* g
    cdef double* u
    cdef double* part_g
    cdef double* part_u
    cdef double* restitution
    cdef double* impulse
    cdef Py_ssize_t* closed
    cdef double* A_q
    cdef double* A_v
    cdef double* A_f
    cdef double* X
    cdef double* W
    cdef void place_saved(self)
    cdef Py_ssize_t halves(self, double t, double h, double slow) noexcept nogil
    cdef Py_ssize_t part(self, int part, double start, double h, double slow) noexcept nogil
    cdef void place(self, int level, double h) noexcept nogil
    cdef void before(self, double slow) noexcept nogil
    @cython.locals(struck=bint)
    cdef void after_part(self, double h, double slow) noexcept nogil
    cdef void keep_times(self, double t, double t_next) noexcept nogil


cdef double dip(double g, double u, double u_next, double h) noexcept nogil
