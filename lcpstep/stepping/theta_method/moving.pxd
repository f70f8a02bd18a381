from lcpstep.kernels.record cimport Record

cdef class Rows

cdef class Plan:
    cdef readonly object matrices
    cdef public double h, theta, slack
    cdef public bint constant
    cdef bint stiff
    cdef Doubles A_q, A_v, A_f, X, W

cdef class State:
    cdef readonly object arrays
    cdef object numbers, marks, work
    cdef readonly Py_ssize_t n_q, n_c, n_moving
    cdef public Py_ssize_t active, steps, problems, forces, iteration
    cdef double changed, moved, opened
    cdef public Record record
    cdef Doubles q, v, force, g, u, impulse
    cdef Indices closed, sticks
    cdef Doubles next_q, next_v, next_force, v_free, q_between, v_between, R, try_v, try_q, try_f, M, M_start
    cdef Doubles A, J, far, slack
    cdef Indices pivots

cdef class Blows:
    cdef object kept
    cdef bint several, last, ends
    cdef double least, fastest, slow
    cdef Py_ssize_t taken, n_a
    cdef Indices ids
    cdef Doubles v, u, sliding, own_v, own_u, own_sliding, p, u_before

cdef class Rows:
    cdef readonly object arrays
    cdef object numbers, blown, looked_at, repair, on_joints
    cdef readonly Model joints, tangents
    cdef readonly ContactProblem problem
    cdef readonly Coefficients coefficients
    cdef readonly Py_ssize_t n_c, n_t, n_j, n
    cdef Py_ssize_t n_f
    cdef readonly bint projected, turning, in_turn, external
    cdef public bint solved
    cdef Elimination elimination
    cdef readonly Blows blows
    cdef Doubles H, T, J, J_start, D, H_t, T_t, J_t, p, sliding, at_rest, tangent_restitution
    cdef Indices failed, near, left_out, reached
    cdef Doubles answers, mobilities, masses
    cdef Doubles gaps, entered, joint_gaps, push, M, Y, S
    cdef Doubles G, J_there, G_t, J_t_there, S_there
