cimport cython
from lcpstep.events.flight.motion cimport Flight
from lcpstep.kernels.course cimport Events

cdef Py_ssize_t DONE, NOT_FINITE, SLACK
cdef double CLOSED, JUST_RELEASED, NONE, ON_THE_SURFACE, STRIDE, UNSEEN


cdef class Course(Events):
    cdef Flight s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef bint go_further(Flight s) noexcept nogil
cdef bint finite(double g, double u, double alpha) noexcept nogil
cdef bint begin(Flight s) noexcept nogil
@cython.locals(is_hop=bint)
cdef bint fly(Flight s) noexcept nogil
cdef bint skim(Flight s) noexcept nogil
cdef bint leap(Flight s) noexcept nogil
cdef void pass_end(Flight s, double end) noexcept nogil
cdef bint rest(Flight s) noexcept nogil
