cdef class ContactProblem:
    cdef readonly object arrays
    cdef readonly object lists
    cdef object space
    cdef Doubles mobility, rate, impulse, mu, W, b, z, slow, fast, made, sum
    cdef Indices ids, carrier
    cdef bint warm, again
    cdef Workspace work
