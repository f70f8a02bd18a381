cdef double[4] NODES, WEIGHTS

cdef class Polynomial:
    cdef readonly object kept
    cdef readonly double scale
    cdef readonly Py_ssize_t degree
    cdef Doubles T, a, q, v, q_stage, v_stage, q_end, v_end, gap_from, rate_from, gap_to, rate_to, rate_now, pressed
    cdef Turn turn
