from lcpstep.arrays cimport doubles


cdef class Plan:
    cdef readonly object matrices
    cdef public double h, theta, slack
    cdef public bint constant
    cdef double* A_q
    cdef double* A_v
    cdef double* A_f
    cdef double* X
    cdef double* W
