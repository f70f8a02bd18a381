from lcpstep.pointers cimport Doubles


cdef class Plan:
    cdef readonly object matrices
    cdef public double h, theta, slack
    cdef public bint constant
    cdef Doubles A_q, A_v, A_f, X, W
