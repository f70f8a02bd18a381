cimport cython
from lcpstep.pointers cimport Doubles
from lcpstep.stepping.theta_method.moving cimport Rows, State

cdef double EDGE


@cython.final
cdef class Edges:
    cdef object kept
    cdef Py_ssize_t n_c
    cdef bint passed
    cdef double depth
    cdef Doubles bend, forced, below
    @cython.locals(along=double, forced=double)
    cdef void note(self, Py_ssize_t half, double h, State s, Rows rows, double* v, double* g, double* u) noexcept nogil
    @cython.locals(other=Py_ssize_t)
    cdef void find(self, Py_ssize_t* held, double slow) noexcept nogil


cdef double dip(double g, double u, double u_next, double h) noexcept nogil
