from lcpstep.kernels.model cimport Model

cdef class Point:
    cdef object numbers
    cdef Model m
    cdef Py_ssize_t n
    cdef Doubles M, work, G, shifted, rate, out
