cimport cython
from lcpstep.lcp.part cimport Part
from lcpstep.lcp.sparse_rows cimport SparseRows
from lcpstep.pointers cimport Doubles

cdef double STRICT, ROUNDING, NOTHING


@cython.final
cdef class Attempt:
    cdef readonly dict arrays
    cdef readonly object marks
    cdef readonly double residual
    cdef object whole
    cdef Part part
    cdef double scale
    cdef Doubles r, c, c_size, x, z, w, size_x, size_w, left, noise, diagonal, mobility, defect
    cdef Doubles all_diagonal, all_mobility
    cdef unsigned char* chosen
    cpdef void pose(self, object r, object c, object c_size)
    cpdef void begin(self)
    cpdef double change(self, object by)
    cpdef double put(self, object x, object z)
    cpdef void judge(self)
    cpdef Py_ssize_t exchange(self)


cdef bint finite(double* x, Py_ssize_t n) noexcept nogil
cdef void gather(double* target, double* source, Py_ssize_t* where, Py_ssize_t n) noexcept nogil
cdef double changed(Attempt a, double* by) noexcept nogil
cdef double error_of_x(Attempt a) noexcept nogil
cdef void measure(Attempt a) noexcept nogil
cdef void judge(Attempt a) noexcept nogil
cdef void feel(Attempt a) noexcept nogil
cdef double largest_size(Attempt a) noexcept nogil
cdef double violation(Attempt a, Py_ssize_t i) noexcept nogil
cdef double share(Attempt a, SparseRows G, Py_ssize_t i) noexcept nogil
cdef Py_ssize_t exchange(Attempt a) noexcept nogil
