from lcpstep.kernels.clock cimport Clock
from lcpstep.kernels.record cimport Record

cdef class Plan:
    cdef object kept
    cdef public double h, made_for
    cdef readonly bint stiff, steady, plain, constant, exact
    cdef readonly double slack, longest, margin
    cdef readonly Py_ssize_t per_step
    cdef public Py_ssize_t many
    cdef Clock clock
    cdef Doubles A_inverse, AG, WA

cdef class Work:
    cdef readonly object numbers, marks, matrices, places, seen
    cdef readonly Py_ssize_t n_q, n_c
    cdef Workspace lcp
    cdef Bracket bracket
    cdef Doubles q, v, a_free, a, force, next_force, q_try, v_try, a_try, jolt, q_from, v_from, a_from
    cdef Doubles q_time, swing, v_struck, gap, velocity, half, alpha, bend, bias, gap_try, gap_t, gap_t_try, end_s
    cdef Doubles last, force_now, older, older_time, p, b, z, residual, change, doubt, before, impulse_from
    cdef Doubles since, next_zero, turned, turns, hops, fall, pushed, impulse, G, G_try, MG, W, M, problem
    cdef Indices status, grounded, hits, close_hits, plastic, chosen, held, place, first_coordinate
    cdef Indices last_coordinate, first_contact, last_contact, moved
    cdef public double t_step, sigma, end, low, high, stalled, settled, ahead, blind, goal, off
    cdef public bint under_way, unchanged, touching, pausing, fresh
    cdef Py_ssize_t n_held
    cdef public Py_ssize_t events, closed_now, made_with
    cdef public Py_ssize_t steps, lcp_calls, force_evaluations, events_left, cut, members, idle
    cdef Sudden sudden
    cdef Doubles end_u
    cdef public double jump, margin
    cdef public Record record
