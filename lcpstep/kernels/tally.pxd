cdef class Tally:
    cdef public Py_ssize_t steps, parts, events, stalled, max_events
