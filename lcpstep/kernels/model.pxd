cimport cython
from lcpstep.arrays cimport doubles
from lcpstep.kernels.function cimport Function, Functions
from lcpstep.pointers cimport after


@cython.final
cdef class Model:
    cdef object kept, of_modes
    cdef readonly dict arrays
    cdef readonly Py_ssize_t n_q, n_c
    cdef public Py_ssize_t mode
    cdef readonly bint linear, flat, moded
    cdef Functions modes
    cdef public bint carried
    cdef readonly double omega
    cdef double* M
    cdef double* M_inverse
    cdef double* C
    cdef double* K
    cdef double* constant
    cdef double* cosine
    cdef double* sine
    cdef double* G
    cdef double* offset
    cdef double* restitution
    cdef double* frame_now
    cdef double* motion_now
    cdef double* x
    cdef double* x_t
    cdef double* mass_now
    cdef readonly Function force, frame, mass, force_q, force_v, motion, gap, jacobian, gap_t, bias
