cimport cython
from lcpstep.arrays cimport doubles
from lcpstep.events.friction.smooth cimport Smooth
from lcpstep.events.friction.state cimport GUARDS
from lcpstep.kernels.vectors cimport add, clear, copy, finite
from lcpstep.pointers cimport after, min

cdef Py_ssize_t ARRIVAL


cdef class Strides(Smooth):
    cdef object ends
    cdef Py_ssize_t order, n_steps
    cdef double h, t_start, tolerance, span, size_q, size_v
    cdef bint going
    cdef double* leaving
    cdef double* arriving
    cdef double* middle
    cdef double* push
    cdef double* begin_value
    cdef double* begin_slope
    cdef double* end_value
    cdef double* end_slope
    cdef double* middle_value
    cdef double* half_value
    cdef double* quarter_value
    cdef double* late_value
    cdef double* refined
    cdef double* stored
    cdef double* stored_rates
    cdef double* stored_forces
    cdef double* arrival
    cdef bint step(self, double t, double h) noexcept nogil
    cdef bint complete(self, double t, double h) noexcept nogil
    cdef double pressed(self, Py_ssize_t i, double x) noexcept nogil
    cdef double goal(self, Py_ssize_t steps) noexcept nogil


cdef bint verlet(Strides s, double t, double h) noexcept nogil
@cython.locals(length=double)
cdef bint classical(Strides s, double t, double h) noexcept nogil
cdef void arrive(Strides s) noexcept nogil
