cimport cython
from lcpstep.stepping.located_parts cimport Parts

cdef Py_ssize_t REACHED, TRIALS
cdef double EARLY, NEAR


cdef class Attempts(Parts):
    @cython.locals(entire=bint, early=bint, agreed=bint)
    cdef Py_ssize_t attempt(self) noexcept nogil
    cdef bint is_stuck(self) noexcept nogil
    @cython.locals(event_first=bint)
    cdef void weigh(self, double length) noexcept nogil
    cdef double depth(self) noexcept nogil
    @cython.locals(struck=bint)
    cdef double sunk(self) noexcept nogil
    cdef double astray(self) noexcept nogil
    @cython.locals(lasts=bint)
    cdef double wrong(self, double length) noexcept nogil
    cdef double held_on(self, Py_ssize_t c, double length) noexcept nogil
