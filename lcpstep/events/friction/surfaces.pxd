cimport cython
from lcpstep.events.friction.state cimport Rubbing

cdef Py_ssize_t OPEN
cdef double FREE, LATE, TOGETHER

cdef bint project(Rubbing s, double t) noexcept nogil
@cython.locals(zero=bint)
cdef bint is_on_rows(Rubbing s) noexcept nogil
cdef bint take_rows(Rubbing s, double t) noexcept nogil
cdef void push_by_change(Rubbing s, double* x) noexcept nogil
cdef void lift(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double touching(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void find_touching(Rubbing s) noexcept nogil
cdef bint contradict(Rubbing s) noexcept nogil
cdef bint come_apart(Rubbing s) noexcept nogil
