cimport cython
from lcpstep.kernels.clock cimport Clock
from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport Doubles, Indices
from lcpstep.stepping.hidden_edges cimport Edges
from lcpstep.stepping.hidden_switches cimport Switches
from lcpstep.stepping.step_control cimport Control
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State
from lcpstep.stepping.theta_method.theta_loop cimport Steps

cdef Py_ssize_t LEVELS, OWN, FINISHED, BUFFER_FULL
cdef double LATE


cdef class Attempts(Control):
    cdef Steps way
    cdef Model m
    cdef Plan plan
    cdef State s
    cdef Rows rows
    cdef Switches switches
    cdef Edges edges
    cdef object kept
    cdef Clock clock
    cdef bint struck, at_corner, even, blow
    cdef double share, ends
    cdef Doubles times
    cdef Py_ssize_t steps_before
    cdef Doubles begin, one_q, one_v, part_q, part_v, between_q, between_v, part_g, part_u, begin_v
    cdef Indices closed
    cdef Doubles A_q, A_v, A_f, X, W
    cdef void place_saved(self)
    cdef void look_for_edges(self, double h, double slow) noexcept nogil
    cdef Py_ssize_t halves(self, double t, double h, double slow) noexcept nogil
    cdef Py_ssize_t part(self, int part, double start, double h, double slow) noexcept nogil
    cdef double ahead(self) noexcept nogil
    cdef void look_ahead(self, double t) noexcept nogil
    cdef void place(self, int level, double h) noexcept nogil
    cdef void before(self, double slow) noexcept nogil
    @cython.locals(struck=bint, thrown=bint, closes=bint)
    cdef void after_part(self, double h, double slow) noexcept nogil
    cdef void keep_times(self, double t, double t_next) noexcept nogil
