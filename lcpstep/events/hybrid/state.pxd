cdef class Motion(RungeKutta):
    cdef object kept_rows, kept_dense, kept_log, lists, of_guards, samples
    cdef readonly Machine m
    cdef Scan scan
    cdef public double t_end, longest, now, last_switch
    cdef public Py_ssize_t max_events, mode, due, steps, events, stalled, row, switches
    cdef bint begun, was_armed
    cdef double place, slope, curvature, event_at, secant, missed, tried, brief
    cdef Py_ssize_t acting, row_capacity, log_capacity
    cdef Indices armed
    cdef Doubles band, states, rows, dense_rows, log
