cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN
cdef double NODE_0, NODE_1, NODE_2, NODE_3, OUTER, INNER, REMAINDER, LONGER, SHORT, LOW, FAINT, STEADY, UNLIKE
cdef double NEVER

@cython.locals(carried=bint, low=bint, begins=bint)
cdef void begin_hops(Rubbing s) noexcept nogil
cdef void find_landings(Rubbing s, double h) noexcept nogil
@cython.locals(low=bint)
cdef double landing(Rubbing s, Py_ssize_t c, double h) noexcept nogil
cdef double shortest_hop(Rubbing s) noexcept nogil
cdef double hop_time(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint is_low(Rubbing s, Py_ssize_t c, double h) noexcept nogil
@cython.locals(f=double, u=double, exact=bint)
cdef double hop_end(Rubbing s, Py_ssize_t c, double guess, double longest) noexcept nogil
cdef bint ends_so(Rubbing s, Py_ssize_t c, double tau) noexcept nogil
@cython.locals(exact=bint)
cdef (double, double, bint) follow(Rubbing s, Py_ssize_t c, double tau) noexcept nogil
cdef double change_of_bend(Rubbing s, Py_ssize_t c, double tau) noexcept nogil
cdef double eighth_power(double d0, double d1, double d2, double d3, double most) noexcept nogil
@cython.locals(first=Py_ssize_t)
cdef Py_ssize_t first_landing(Rubbing s) noexcept nogil
@cython.locals(f=double, _=bint, rises=bint)
cdef void interrupt(Rubbing s, Py_ssize_t g, double tau) noexcept nogil
cdef void carry(Rubbing s) noexcept nogil
