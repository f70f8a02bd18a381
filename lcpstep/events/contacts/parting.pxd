cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN, SLIDES, DONE

@cython.locals(rises=bint)
cdef void part_before(Rubbing s) noexcept nogil
@cython.locals(landed=bint, new=bint)
cdef bint let_go(Rubbing s, double t) noexcept nogil
cdef void rejoin(Rubbing s) noexcept nogil
@cython.locals(hit=bint)
cdef bint approaches(Rubbing s) noexcept nogil
