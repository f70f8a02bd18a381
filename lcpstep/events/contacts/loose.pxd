cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.pointers cimport Doubles

cdef Py_ssize_t OPEN, SLIDES, STAGES
cdef double NEAR, DRIFT, EARLIER, MORE

cdef void find_loose(Rubbing s) noexcept nogil
@cython.locals(sticks=bint)
cdef bint is_loose(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void forget_strays(Rubbing s) noexcept nogil
cdef void notice(Rubbing s, double place, double t) noexcept nogil
cdef bint first_stray(Rubbing s, double h, double low, double high) noexcept nogil
cdef double first_beyond(Rubbing s, double low, double high, double h, double level) noexcept nogil
@cython.locals(mode=Py_ssize_t)
cdef Py_ssize_t straying(Rubbing s, Doubles a, double level) noexcept nogil
cdef bint strays(Rubbing s, Py_ssize_t i, Doubles a, double least) noexcept nogil
