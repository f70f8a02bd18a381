from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef double RESOLUTION, NOISE, NUDGE


cdef class Clock:
    cdef object corner_array
    cdef public double t0, t0_rest, rest, low, high, t_end, scale, period, last_event, jump
    cdef double* corners
    cdef Py_ssize_t n_corners
    cdef double after(self, double tau) noexcept nogil
    cdef void start_at(self, double t) noexcept nogil
    cdef void log(
        self, Record record, Tally tally, double t, Py_ssize_t c, Py_ssize_t kind, double before, double later, double p
    ) noexcept nogil
    cdef double untold(self, double length) noexcept nogil
    cdef double inside(self, double t) noexcept nogil
    cdef bint lies_apart(self, double t) noexcept nogil
    cdef void break_at(self, double t) noexcept nogil
    cdef void find_corners(self, double t) noexcept nogil
    cdef void find_named(self, double near) noexcept nogil
