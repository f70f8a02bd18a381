cdef class Control(Course):
    cdef Record record
    cdef object make, matrices, own_made
    cdef Py_ssize_t n_times, row, event, asked, jumped
    cdef Indices made
    cdef public Py_ssize_t position, until, end, tried
    cdef public Py_ssize_t level, finest
    cdef public double start, stop, span, h_max, tolerance, enough, size_q, size_v, last, into
    cdef public double apart_q, apart_v, far_q, far_v, acceleration, cut
    cdef public bint happened, failed, hopeless, full
