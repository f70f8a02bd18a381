cdef class Attempt:
    cdef readonly dict arrays
    cdef readonly object marks
    cdef readonly double residual
    cdef object whole
    cdef Part part
    cdef double scale
    cdef Doubles r, c, c_size, x, z, w, size_x, size_w, left, noise, diagonal, mobility, defect
    cdef Doubles all_diagonal, all_mobility
    cdef Flags chosen
