cimport cython
from lcpstep.arrays cimport doubles, indices

cdef Py_ssize_t ENDS, IMPACTS


@cython.final
cdef class Answers:
    cdef object task
    cdef double t_start, t_end
    cdef Py_ssize_t drop, periods, runs, kept, most, n_targets
    cdef bint strict, has_tangents
    cdef double* starts
    cdef double* targets
    cdef double* radius
    cdef double* scale
    cdef double* states
    cdef double* impacts
    cdef double* landings
    cdef double* tangents
    cdef double* final
    cdef Py_ssize_t* counts
    cdef Py_ssize_t* reached
    cdef Py_ssize_t* taken
    cdef Py_ssize_t* codes
    cdef void note_impact(self, Py_ssize_t i, Py_ssize_t k, double t, double before, double after) noexcept nogil
    cdef void note_landing(self, Py_ssize_t i, Py_ssize_t k, double t) noexcept nogil
