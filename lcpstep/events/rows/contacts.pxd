cdef class Contacts(Rows):
    cdef object contact_numbers, marks
    cdef public Py_ssize_t next, culprit
    cdef Py_ssize_t rounds, stalled
    cdef bint mapped
    cdef readonly ContactProblem problem
    cdef Doubles q, v, dv, each, a, effect, multiplier, gap, velocity, impulse, turn_impulse, turn_velocity, instant, terms, owed
    cdef Doubles before, curve, struck, since, left, chatter_end, mu, mu_s, direction, was_direction
    cdef Indices rough, mode, was_mode, tried, loaded, may_stick, touches, parting
