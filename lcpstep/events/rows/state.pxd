cdef class Rows(Clock):
    cdef object row_numbers, row_list
    cdef readonly Model model, joints, tangents
    cdef readonly Py_ssize_t n_q, n_c, n_j, n_t, n_r, n_held, n_kept
    cdef Py_ssize_t n_moved
    cdef readonly bint fixed, moving
    cdef bint on_joints, known
    cdef readonly double rtol, atol
    cdef public double far, fast, longest
    cdef Sudden sudden
    cdef double gap_drift
    cdef Doubles a_free, force, work, shifted, M, R, MR, D, G, rate, bias, near, further
    cdef Doubles held, change, share, pivot_error, L, bias_on, R_on, MR_on, D_on, idle
    cdef Indices row, either, rests, reach, moved
