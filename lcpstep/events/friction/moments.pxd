cimport cython
from lcpstep.events.friction.state cimport Rubbing

cdef Py_ssize_t STAGES, REFINEMENTS
cdef double NEAR

cdef bint jumps(Rubbing s, Py_ssize_t g, double tau) noexcept nogil
@cython.locals(falls=bint)
cdef double close_in(Rubbing s, Py_ssize_t g, double tau, double longest) noexcept nogil

cdef double locate(Rubbing s, Py_ssize_t g, double h, double longest) noexcept nogil
cdef double missing(Rubbing s, Py_ssize_t g) noexcept nogil
cdef double creep(Rubbing s, Py_ssize_t g, double tau, double change, double longest) noexcept nogil
