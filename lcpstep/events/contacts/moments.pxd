cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t SLIDES, STAGES, REFINEMENTS
cdef double NEAR

cdef bint jumps(Rubbing s, Py_ssize_t g, double tau) noexcept nogil
cdef bint turns_at_once(Rubbing s, Py_ssize_t g, double tau, double h) noexcept nogil
cdef bint of_sliding(Rubbing s, Py_ssize_t g) noexcept nogil
@cython.locals(falls=bint)
cdef double close_in(Rubbing s, Py_ssize_t g, double tau, double longest) noexcept nogil

cdef double locate(Rubbing s, Py_ssize_t g, double h, double longest) noexcept nogil
cdef double missing(Rubbing s, Py_ssize_t g) noexcept nogil
cdef double creep(Rubbing s, Py_ssize_t g, double tau, double change, double longest) noexcept nogil
