cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly Work w
    cdef bint gliding, ends, watched, asking, told
    cdef double tau
    cdef public double stop
    cdef Py_ssize_t found, own
