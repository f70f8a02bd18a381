cimport cython
from lcpstep.kernels.vectors cimport distance, largest
from lcpstep.pointers cimport abs, after, inf, max, min
from lcpstep.stepping.hidden_forces cimport hidden, late
from lcpstep.stepping.located_parts cimport Parts
from lcpstep.stepping.pieces.codes cimport BUFFER_FULL, CLOSED, FINISHED, STOPPED

cdef Py_ssize_t REACHED, TRIALS
cdef double EARLY, NEAR


cdef class Attempts(Parts):
    @cython.locals(entire=bint, early=bint, agreed=bint)
    cdef Py_ssize_t attempt(self) noexcept nogil
    @cython.locals(event_first=bint)
    cdef void weigh(self, double length) noexcept nogil
    cdef double depth(self) noexcept nogil
    cdef double wrong(self, double length) noexcept nogil
