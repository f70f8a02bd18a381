cimport cython
from lcpstep.pointers cimport Doubles

cdef Py_ssize_t COLUMNS, ROOM


@cython.final
cdef class Record:
    cdef object given, columns
    cdef readonly Py_ssize_t n_q, n_c, n_times, row_size, row_capacity, event_capacity, dense_size
    cdef public Py_ssize_t every, row, event, next_time
    cdef public bint on_events
    cdef Doubles times, events, t, mode, length, q, v, impulse, dense
    cdef double last_time(self) noexcept nogil
    cdef void keep(self, double t, double mode, double* q, double* v, double* impulse) noexcept nogil
    cdef void keep_awaited(self, double* q, double* v, double* impulse) noexcept nogil
    cdef void store(self, double* motion, double length) noexcept nogil
    cdef void note(
        self, double t, Py_ssize_t contact, double before, double after_, double p, Py_ssize_t kind
    ) noexcept nogil
    cdef bint full(self, Py_ssize_t more) noexcept nogil
    cdef double awaited(self) noexcept nogil
    cdef bint wants(self, double stop, bint last) noexcept nogil
    cdef bint is_due(self, Py_ssize_t step) noexcept nogil
    cdef bint keeps_events(self) noexcept nogil
    cdef bint take_back(self, double t, double* impulse) noexcept nogil
    cdef void back_to(self, Py_ssize_t row) noexcept nogil
    cdef void read_last(self, double* row) noexcept nogil
    cdef void write_last(self, double* row) noexcept nogil
    cdef Py_ssize_t room_until(self, Py_ssize_t step, Py_ssize_t last) noexcept nogil
    cdef Py_ssize_t quiet_until(
        self, Py_ssize_t step, double h, double t0, Py_ssize_t first, Py_ssize_t last
    ) noexcept nogil
    cdef Py_ssize_t untimed_until(self, double h, double t0, Py_ssize_t first, Py_ssize_t last) noexcept nogil
