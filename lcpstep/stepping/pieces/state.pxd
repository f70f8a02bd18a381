cimport cython
from lcpstep.arrays cimport doubles, indices
from lcpstep.kernels.bracket cimport Bracket
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport after, indices_after
from lcpstep.stepping.pieces.joints cimport Joints


@cython.final
cdef class Plan:
    cdef readonly object fields
    cdef object kept
    cdef public double h, made_for
    cdef readonly bint trapezoidal, joined, stiff, steady, plain, constant, small, exact
    cdef readonly double slack, longest, period, margin
    cdef readonly Py_ssize_t per_step, many, n_corners
    cdef double* corners
    cdef double* A_inverse
    cdef double* AG
    cdef double* WA
    cdef double* A
    cdef double* unit
    cdef Py_ssize_t* pivots


@cython.final
cdef class Work:
    cdef readonly object numbers, marks, matrices, places
    cdef readonly Py_ssize_t n_q, n_c, n_j
    cdef readonly bint joined
    cdef readonly Joints joints
    cdef Workspace lcp
    cdef Bracket bracket
    cdef double* q
    cdef double* v
    cdef double* free
    cdef double* a
    cdef double* force
    cdef double* next_force
    cdef double* q_base
    cdef double* q_try
    cdef double* v_try
    cdef double* a_try
    cdef double* jolt
    cdef double* q_from
    cdef double* v_from
    cdef double* a_from
    cdef double* q_time
    cdef double* swing
    cdef double* v_struck
    cdef double* gap
    cdef double* rate
    cdef double* half
    cdef double* alpha
    cdef double* bend
    cdef double* bias
    cdef double* gap_try
    cdef double* gap_t
    cdef double* gap_t_try
    cdef double* end_s
    cdef double* last
    cdef double* force_now
    cdef double* older
    cdef double* older_time
    cdef double* p
    cdef double* b
    cdef double* z
    cdef double* residual
    cdef double* change
    cdef double* doubt
    cdef double* before
    cdef double* impulse_from
    cdef double* since
    cdef double* next_zero
    cdef double* turned
    cdef double* turns
    cdef double* hops
    cdef double* fall
    cdef double* pushed
    cdef double* impulse
    cdef double* G
    cdef double* G_try
    cdef double* MG
    cdef double* W
    cdef double* M
    cdef double* problem
    cdef Py_ssize_t* status
    cdef Py_ssize_t* grounded
    cdef Py_ssize_t* hits
    cdef Py_ssize_t* close_hits
    cdef Py_ssize_t* plastic
    cdef Py_ssize_t* chosen
    cdef Py_ssize_t* held
    cdef Py_ssize_t* place
    cdef Py_ssize_t* first_coordinate
    cdef Py_ssize_t* last_coordinate
    cdef Py_ssize_t* first_contact
    cdef Py_ssize_t* last_contact
    cdef Py_ssize_t* pivots
    cdef public double sigma, end, low, high, stalled, settled, ahead, blind, goal
    cdef public bint under_way, unchanged, touching, pausing, fresh
    cdef public Py_ssize_t events, closed_now, made_with
    cdef public Py_ssize_t steps, lcp_calls, force_evaluations, events_left, cut, members, idle
    cdef void place_vectors(self, double* x)
    cdef void place_numbers(self, double* x)
    cdef void place_marks(self, Py_ssize_t* x)
    cdef void place_matrices(self, double* x)
