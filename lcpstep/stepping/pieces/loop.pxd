cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly Work w
    cdef bint gliding, ends, told, doubtful
    cdef double tau
    cdef Py_ssize_t found, own
