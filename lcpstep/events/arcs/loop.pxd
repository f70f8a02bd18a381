cimport cython
from lcpstep.events.arcs.motion cimport Arc
from lcpstep.kernels.course cimport Events

cdef Py_ssize_t STAYS_CLOSED, DONE, REVERSE, SLACK, SLIP, STICK_TANGENT
cdef double STILL


cdef class Course(Events):
    cdef Arc s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


@cython.locals(slides=bint)
cdef void begin(Arc s) noexcept nogil
cdef void note(Arc s, Py_ssize_t kind) noexcept nogil
cdef void decide(Arc s) noexcept nogil
cdef void follow(Arc s, bint slides) noexcept nogil
cdef double first_end(Arc s, double limit) noexcept nogil
cdef double touch(Arc s, double tau, double u) noexcept nogil
cdef double leave(double u, double bend, double second, double third, double noise) noexcept nogil
cdef void step(Arc s) noexcept nogil
cdef void turn(Arc s, double t) noexcept nogil
cdef void keep(Arc s, double tau, double t) noexcept nogil
cdef void keep_times(Arc s, double stop, bint last) noexcept nogil
cpdef object show(Arc s)
cpdef object evaluate(Arc s, object kept, object coordinates, object times, object row, object q, object v)
