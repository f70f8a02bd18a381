cimport cython
from lcpstep.pointers cimport Doubles, Indices
from lcpstep.stepping.pieces.state cimport Work


@cython.final
cdef class Led:
    cdef object kept
    cdef Py_ssize_t code
    cdef double time, off
    cdef Doubles q, v, gap, half, force, impulse
    cdef Indices status
    cdef bint good(self) noexcept nogil


cdef void copy_state(
    Work to, Work w, Py_ssize_t n_numbers, Py_ssize_t n_marks, Py_ssize_t n_matrices
) noexcept nogil
