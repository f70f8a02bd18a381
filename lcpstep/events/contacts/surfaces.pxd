cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN
cdef double FREE, GONE, LATE, SURE, TOGETHER

@cython.locals(straight=bint)
cdef bint lift(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint is_known(Rubbing s, Py_ssize_t c, double* way, double speed) noexcept nogil
@cython.locals(downwards=bint)
cdef bint has_room(Rubbing s, Py_ssize_t c, double* way, double speed, double g) noexcept nogil
cdef bint come_to_rest(Rubbing s) noexcept nogil
cdef double touching(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double nearly(Rubbing s, Py_ssize_t c, double share) noexcept nogil
@cython.locals(still=bint)
cdef void find_closed(Rubbing s) noexcept nogil
cdef void find_touching(Rubbing s) noexcept nogil
cdef void find_coming(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint contradict(Rubbing s) noexcept nogil
cdef bint come_apart(Rubbing s) noexcept nogil
