from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef class Clock:
    cdef object corner_array
    cdef public double t0, t0_rest, rest, low, high, t_end, scale, period, last_event, jump
    cdef Doubles corners
    cdef Py_ssize_t n_corners
    cdef public Record record
    cdef public Tally tally
