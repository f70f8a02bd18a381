cdef class Polynomial:
    cdef readonly object kept
    cdef readonly double t, scale
    cdef readonly Py_ssize_t degree
    cdef Doubles T, a, q, v, q_stage, v_stage, q_end, v_end, gap_from, velocity_from, gap_to, velocity_to, velocity_now
    cdef Doubles pressed
    cdef Turn turn
