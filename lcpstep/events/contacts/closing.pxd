cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN, SLIDES, STICKS

@cython.locals(rough=bint)
cdef void close(Rubbing s, Py_ssize_t c, bint at_rest) noexcept nogil
cdef Py_ssize_t mode_closed(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint slides_on(Rubbing s, Py_ssize_t i, double slip) noexcept nogil
cdef bint leaves_cone(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(direction=double, mode=Py_ssize_t)
cdef void take_back(Rubbing s, Py_ssize_t c) noexcept nogil
