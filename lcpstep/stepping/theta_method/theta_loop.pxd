cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly State s
    cdef readonly Rows rows
    cdef readonly Record record
    cdef bint single
