cimport cython
from lcpstep.arrays cimport doubles
from lcpstep.kernels.acceleration cimport divide_by_mass, free_acceleration
from lcpstep.kernels.dynamics cimport bias, gap_rates
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport Doubles, after, inf


@cython.final
cdef class Point:
    cdef object numbers
    cdef Model m
    cdef Py_ssize_t n
    cdef Doubles M, work, G, shifted, rate, out
