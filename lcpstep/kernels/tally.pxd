cdef class Tally:
    cdef public Py_ssize_t steps, parts, forces, events, stalled, max_events
