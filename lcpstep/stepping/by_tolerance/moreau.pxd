from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

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
