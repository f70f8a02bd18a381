cdef class Record:
    cdef object given, columns
    cdef readonly Py_ssize_t n_q, n_c, n_times, row_size, row_capacity, event_capacity, dense_size
    cdef public Py_ssize_t every, row, event, next_time
    cdef public bint on_events
    cdef Doubles times, events, t, mode, length, q, v, impulse, dense
