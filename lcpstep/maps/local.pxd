from lcpstep.arrays cimport doubles
from lcpstep.kernels.acceleration cimport free_acceleration
from lcpstep.kernels.dynamics cimport bias as gap_bias, gap_rates, mass
from lcpstep.kernels.linear cimport positive_definite, solve_definite
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.vectors cimport copy, product


cdef class Local:
    cdef readonly object scene
    cdef readonly Model model
    cdef readonly double restitution
    cdef object vectors, matrices
    cdef double* a
    cdef double* y
    cdef double* MG
    cdef double* g_t
    cdef double* shifted
    cdef double* out
    cdef double* M
    cdef double* G
    cdef double* G_shifted
