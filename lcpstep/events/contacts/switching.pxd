cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t BUFFER_FULL, DONE, ENDLESS_SWITCHING, ENTERED, INSIDE, JUMPED, LOOKED, NOT_FINITE, NOT_TRANSVERSAL
cdef Py_ssize_t OPEN, SWITCH, TOO_MANY_EVENTS


cdef class Watched(Motion):
    cdef Rubbing rubbing
    cdef void take_numbers(self, Rubbing s) noexcept nogil
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil

@cython.locals(k=Py_ssize_t, at=double, slope=double, curvature=double)
cdef Py_ssize_t watch(Rubbing s, double h, double end) noexcept nogil
cdef double reach_guard(Rubbing s, double h) noexcept nogil
cdef void look_at_guards(Rubbing s) noexcept nogil
cdef Py_ssize_t switch(Rubbing s, Tally tally) noexcept nogil
cdef Py_ssize_t place(Rubbing s, bint moved) noexcept nogil
