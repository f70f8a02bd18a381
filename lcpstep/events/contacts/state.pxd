from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.bracket cimport Bracket
from lcpstep.kernels.coulomb cimport ContactProblem
from lcpstep.kernels.model cimport Model

cdef class Rubbing(RungeKutta):
    cdef object table, given, marks, looks, arms
    cdef readonly Contacts rows
    cdef readonly Model model
    cdef readonly ContactProblem problem
    cdef readonly Coefficients coefficients
    cdef Scan scan
    cdef readonly Py_ssize_t n_q, n_c, n_j, n_t, n_r
    cdef public Py_ssize_t jams
    cdef readonly bint in_turn, yields
    cdef readonly double scan_length
    cdef Py_ssize_t guard, paced, loose
    cdef double found, slope, kept_to, shown, delay
    cdef readonly bint constant
    cdef bint plain, risen, sharing
    cdef Doubles q, v, a_free, a, force, dy, seen, dv, R, MR, W
    cdef Doubles rate, bias, gap, velocity, change, multiplier, impulse, instant, paces
    cdef Doubles shifted_rate, counted, total, loads, unsure, effect, effects
    cdef Doubles mu, mu_s, slip, tangential, direction, new_direction, terms, before
    cdef Doubles lands, height, rise, bend, speed, jumped, stray
    cdef Bracket bracket
    cdef readonly Motion watch
    cdef bint hopping, flying
    cdef Py_ssize_t since_look
    cdef Indices mode, was_mode, new_mode, loaded, new_loaded, may_stick, touches, parting, tried, hops, carried, leader
    cdef Doubles value, band, samples
    cdef Indices armed
