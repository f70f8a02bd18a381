cimport cython
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t ENDS, IMPACTS


@cython.final
cdef class Answers:
    cdef object task
    cdef double t_start, t_end
    cdef Py_ssize_t drop, periods, runs, kept, most, n_targets
    cdef bint strict, has_tangents
    cdef Doubles starts, targets, radius, scale, states, impacts, landings, tangents, final
    cdef Indices counts, reached, taken, codes
    cdef void note_impact(self, Py_ssize_t i, Py_ssize_t k, double t, double before, double after) noexcept nogil
    cdef void note_landing(self, Py_ssize_t i, Py_ssize_t k, double t) noexcept nogil
