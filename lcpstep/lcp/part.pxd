cdef class Part:
    cdef readonly dict lists
    cdef readonly Py_ssize_t n, m
    cdef readonly SparseRows A, G, G_T
    cdef SparseRows all_A, all_G, all_G_T
    cdef Py_ssize_t n_all, m_all, n_b, queued
    cdef Indices block, order, block_begin, member, coordinates, rows, x_place, w_place
    cdef Indices queue, entered_block, x_number, w_number
