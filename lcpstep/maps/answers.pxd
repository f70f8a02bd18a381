cdef class Answers:
    cdef object task
    cdef double t_start, t_end
    cdef Py_ssize_t drop, periods, runs, kept, most, n_targets
    cdef bint strict, has_tangents
    cdef Doubles starts, targets, radius, scale, states, impacts, landings, tangents, final
    cdef Indices counts, reached, taken, codes
