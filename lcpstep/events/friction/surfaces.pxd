cimport cython
from lcpstep.events.friction.state cimport Rubbing

cdef Py_ssize_t OPEN
cdef double FREE, LATE, TOGETHER

cdef void lift(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double touching(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void find_touching(Rubbing s) noexcept nogil
cdef bint contradict(Rubbing s) noexcept nogil
cdef bint come_apart(Rubbing s) noexcept nogil
