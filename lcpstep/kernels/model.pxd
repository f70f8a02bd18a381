from lcpstep.kernels.function cimport Functions

cdef class Model:
    cdef readonly object kept
    cdef object of_modes
    cdef readonly dict arrays
    cdef readonly Py_ssize_t n_q, n_c
    cdef public Py_ssize_t mode
    cdef readonly bint linear, flat, moded
    cdef Functions modes
    cdef public bint carried
    cdef readonly double omega
    cdef Doubles M, M_inverse, C, K, constant, cosine, sine, G, offset, restitution, frame_now, motion_now, x
    cdef Doubles x_t, mass_now
    cdef Indices M_ends, C_ends, G_ends
    cdef readonly Function force, frame, mass, force_q, force_v, motion, gap, jacobian, gap_t, bias
