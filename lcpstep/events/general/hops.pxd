cimport cython
from lcpstep.events.general.state cimport Mechanism

cdef double NODE_0, NODE_1, NODE_2, NODE_3, OUTER, INNER, REMAINDER, LONGER, SHORT, LOW, FAINT, STEADY, UNLIKE

cdef void find_landings(Mechanism s, double h) noexcept nogil
@cython.locals(low=bint)
cdef double landing(Mechanism s, Py_ssize_t c, double h) noexcept nogil
cdef double shortest_hop(Mechanism s) noexcept nogil
cdef double hop_time(Mechanism s, Py_ssize_t c, double g, double u, double alpha) noexcept nogil
cdef bint is_low(Mechanism s, Py_ssize_t c, double h) noexcept nogil
@cython.locals(f=double, u=double, exact=bint)
cdef double hop_end(Mechanism s, Py_ssize_t c, double guess, double longest) noexcept nogil
cdef bint ends_so(Mechanism s, Py_ssize_t c, double tau) noexcept nogil
@cython.locals(exact=bint)
cdef (double, double, bint) follow(Mechanism s, Py_ssize_t c, double tau) noexcept nogil
cdef double speed_at(Mechanism s, Py_ssize_t c, double tau) noexcept nogil
cdef double change_of_curve(Mechanism s, Py_ssize_t c, double tau) noexcept nogil
cdef double eighth_power(double d0, double d1, double d2, double d3, double most) noexcept nogil
cdef void interrupt(Mechanism s, Py_ssize_t c, double tau) noexcept nogil
@cython.locals(f=double, u=double, _=bint)
cdef void reach_end(Mechanism s, double h) noexcept nogil
@cython.locals(steady=bint)
cdef void carry(Mechanism s) noexcept nogil
