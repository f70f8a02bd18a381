cdef class Scan:
    cdef object arrays
    cdef Bracket bracket
    cdef Doubles points, to_bernstein, at_checks, sample, c, half, stack, low, high
