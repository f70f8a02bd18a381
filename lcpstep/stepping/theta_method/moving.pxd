from lcpstep.arrays cimport doubles, indices
from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport after, indices_after
from lcpstep.kernels.coefficients cimport Coefficients
from lcpstep.kernels.coulomb cimport ContactProblem
from lcpstep.stepping.constraints.joint_rows cimport Elimination

cdef Py_ssize_t VECTORS, SQUARES


cdef class State:
    cdef readonly object arrays
    cdef object work, order
    cdef readonly Py_ssize_t n_q, n_c
    cdef public Py_ssize_t steps, problems, forces, iteration
    cdef double moved
    cdef double* q
    cdef double* v
    cdef double* force
    cdef double* g
    cdef double* u
    cdef double* impulse
    cdef Py_ssize_t* closed
    cdef Py_ssize_t* sticks
    cdef double* next_q
    cdef double* next_v
    cdef double* next_force
    cdef double* v_free
    cdef double* q_between
    cdef double* v_between
    cdef double* R
    cdef double* try_v
    cdef double* try_q
    cdef double* try_f
    cdef double* M
    cdef double* M_start
    cdef double* A
    cdef double* J
    cdef Py_ssize_t* pivots


cdef class Rows:
    cdef readonly object arrays
    cdef object numbers, looked_at, repair
    cdef readonly Model joints, tangents
    cdef readonly ContactProblem problem
    cdef readonly Coefficients coefficients
    cdef readonly Py_ssize_t n_c, n_t, n_j, n
    cdef readonly bint projected, turning, in_turn
    cdef Elimination elimination
    cdef double* H
    cdef double* T
    cdef double* J
    cdef double* J_start
    cdef double* D
    cdef double* H_t
    cdef double* T_t
    cdef double* J_t
    cdef double* p
    cdef double* sliding
    cdef double* at_rest
    cdef double* tangent_restitution
    cdef Py_ssize_t* failed
    cdef Py_ssize_t* near
    cdef double* gaps
    cdef double* joint_gaps
    cdef double* push
    cdef double* M
    cdef double* Y
    cdef double* S
