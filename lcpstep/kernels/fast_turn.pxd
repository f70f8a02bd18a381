from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport Doubles

cdef class Looks:
    cdef Model m
    cdef object kept
    cdef Py_ssize_t looks, count, k
    cdef double golden, mean, share, h
    cdef Doubles t, q, v, g, bent, largest, start, end, other, x, G, force
