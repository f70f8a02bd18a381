cimport cython
from lcpstep.stepping.rubbing.strides cimport Strides

cdef Py_ssize_t OPEN, SLIDES
cdef double NOWHERE

cdef bint note_base(Strides s, double t) noexcept nogil
cdef bint measure_base(Strides s, double t) noexcept nogil
cdef void widen_bands(Strides s) noexcept nogil
@cython.locals(size=double)
cdef bint note(Strides s, double t, double* y, double* v, double* dy, double* value, double* slope) noexcept nogil
@cython.locals(known=bint)
cdef void note_bends(Strides s, double t, double* y, double* dy, double* bend) noexcept nogil
cdef void know_biases(Strides s, double t, double* y) noexcept nogil
cdef double bend_of(Strides s, Py_ssize_t c, double* dy) noexcept nogil
cdef bint read_guards(Strides s, double t, double* y) noexcept nogil
cdef bint note_arrival(Strides s, double t, double h) noexcept nogil
cdef void note_middle(Strides s, double t, double h, double* value) noexcept nogil
@cython.locals(least=double, place=double, low=double)
cdef Py_ssize_t first_event(Strides s, double h) noexcept nogil
@cython.locals(known=bint)
cdef bint hides(Strides s, double t, double h) noexcept nogil
cdef void arm(Strides s) noexcept nogil
cdef bint is_motion(Strides s, Py_ssize_t g) noexcept nogil
@cython.locals(moves=bint)
cdef double curve(Strides s, Py_ssize_t g, double h) noexcept nogil
cdef Py_ssize_t bend(Strides s, Py_ssize_t g, double h) noexcept nogil
cdef void elevate(Strides s, Py_ssize_t least) noexcept nogil
@cython.locals(rises=bint)
cdef double low_hop(Strides s, Py_ssize_t g, double h) noexcept nogil
cdef double low_flight(double u, double alpha, double band) noexcept nogil
@cython.locals(crossed=bint)
cdef double locate(Strides s, Py_ssize_t g, double h) noexcept nogil
