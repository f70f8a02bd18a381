cimport cython
from lcpstep.lcp.sparse_rows cimport SparseRows
from lcpstep.pointers cimport Indices

cdef Py_ssize_t NOWHERE


@cython.final
cdef class Part:
    cdef readonly dict lists
    cdef readonly Py_ssize_t n, m
    cdef readonly SparseRows A, G, G_T
    cdef SparseRows all_A, all_G, all_G_T
    cdef Py_ssize_t n_all, m_all, n_b, queued
    cdef Indices block, order, block_begin, member, coordinates, rows, x_place, w_place
    cdef Indices queue, entered_block, x_number, w_number
    cpdef bint choose(self, object active, object w)
    cpdef void fill(self, object chosen, object d, Py_ssize_t k, object storage)


cdef void spread(Part part, unsigned char* active, double* w) noexcept nogil
cdef void enter_rows_at(Part part, Py_ssize_t j, unsigned char* active) noexcept nogil
cdef void enter(Part part, Py_ssize_t i) noexcept nogil
@cython.locals(changed=bint)
cdef bint enlist(Part part) noexcept nogil
cdef void take(
    SparseRows target, SparseRows source, Py_ssize_t* rows, Py_ssize_t n, Py_ssize_t* number
) noexcept nogil
cdef void fill(Part part, unsigned char* chosen, double* d, Py_ssize_t k, double* storage) noexcept nogil
