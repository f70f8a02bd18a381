cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t DONE, OPEN, NOT_FINITE
cdef double MOMENT, SHORTEST, SHORTER, DOUBTFUL

@cython.locals(some=bint)
cdef bint opens_any(Rubbing s) noexcept nogil
cdef Py_ssize_t reconsider(Rubbing s, double t, double longest) noexcept nogil
@cython.locals(some=bint, doubtful=bint)
cdef bint pulls(Rubbing s) noexcept nogil
cdef bint foresee(Rubbing s, double t, double tau) noexcept nogil
@cython.locals(untold=bint)
cdef bint cannot_be_told(Rubbing s, double tau) noexcept nogil
