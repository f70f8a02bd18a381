cimport cython
from lcpstep.events.hybrid.field cimport Machine, guard
from lcpstep.events.hybrid.roots cimport Scan
from lcpstep.kernels.rungekutta cimport RungeKutta
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t TIME, LENGTH, ROW_MODE, LEAD, SWITCH_LEAD
cdef double FIRST_STEP


cdef class Motion(RungeKutta):
    cdef object kept_rows, kept_dense, kept_log, lists, of_guards, samples
    cdef readonly Machine m
    cdef Scan scan
    cdef public double t_end, longest, now, last_switch
    cdef public Py_ssize_t max_events, mode, culprit, steps, events, stalled, row, switches
    cdef bint begun, was_armed
    cdef double event_at, rate, missed, tried
    cdef Py_ssize_t row_capacity, log_capacity
    cdef Indices armed
    cdef Doubles band, states, rows, dense_rows, log
    cdef void start_from(self, double t, Py_ssize_t mode) noexcept nogil
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil
    cdef void keep(self, double h) noexcept nogil
    cdef void note(self, Py_ssize_t target, Py_ssize_t guard, double* moved) noexcept nogil
