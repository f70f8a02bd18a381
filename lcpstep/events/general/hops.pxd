cimport cython
from libc.math cimport pow, sqrt
from lcpstep.events.general.earliest cimport NEVER, NONE, observe
from lcpstep.events.general.impact cimport speed_noise
from lcpstep.events.general.parabolas cimport hop
from lcpstep.events.general.state cimport Mechanism, NOISE
from lcpstep.kernels.clock cimport RESOLUTION
from lcpstep.kernels.quadratic cimport first_zero
from lcpstep.kernels.vectors cimport largest
from lcpstep.pointers cimport abs, inf, max, min, nan

cdef double NODE_0, NODE_1, NODE_2, NODE_3, OUTER, INNER, REMAINDER, LONGER, SHORT, LOW, FAINT, STEADY

cdef void find_landings(Mechanism s, double h) noexcept nogil
@cython.locals(low=bint)
cdef double landing(Mechanism s, Py_ssize_t c, double h) noexcept nogil
cdef double shortest_hop(Mechanism s) noexcept nogil
cdef double hop_time(Mechanism s, Py_ssize_t c, double g, double u, double alpha) noexcept nogil
cdef bint is_low(Mechanism s, Py_ssize_t c, double h) noexcept nogil
@cython.locals(f=double, u=double, exact=bint)
cdef double hop_end(Mechanism s, Py_ssize_t c, double guess, double longest) noexcept nogil
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
