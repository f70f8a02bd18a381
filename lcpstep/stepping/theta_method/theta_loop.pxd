cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly State s
    cdef readonly Rows rows
    cdef bint single
