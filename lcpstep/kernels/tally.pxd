cimport cython

cdef Py_ssize_t MAX_STALLED


@cython.final
cdef class Tally:
    cdef public Py_ssize_t steps, forces, events, stalled, max_events
    cdef void add_event(self, bint stalled) noexcept nogil
    cdef void clear(self) noexcept nogil
    cdef bint too_many(self) noexcept nogil
