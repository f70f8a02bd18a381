cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t LEANS, OPEN, SLIDES, STICKS, MOST, WAYS
cdef double STILL

@cython.locals(resting=Py_ssize_t, ways=Py_ssize_t, way=Py_ssize_t)
cdef bint braced(Rubbing s) noexcept nogil
cdef bint rests(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(one=Py_ssize_t)
cdef void choose(Rubbing s, Py_ssize_t way) noexcept nogil
@cython.locals(within=bint, T=Py_ssize_t)
cdef bint carries(Rubbing s, double inside) noexcept nogil
cdef bint is_still(Rubbing s, Py_ssize_t i) noexcept nogil
