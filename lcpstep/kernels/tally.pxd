cdef class Tally:
    cdef public Py_ssize_t steps, forces, events, stalled, max_events
