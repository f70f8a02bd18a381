cimport cython
from lcpstep.pointers cimport Doubles, Indices
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t ONE, FIRST, SECOND
cdef double SHARED, STICKS, SAME


@cython.final
cdef class Switches:
    cdef object kept
    cdef readonly Py_ssize_t n_q, n_c, n
    cdef double slack
    cdef Doubles force, impulse, mobility, response, turned, apart, drop, held_W
    cdef Indices holds, held
    cdef void begin(self, State s, double slow) noexcept nogil
    cdef void note(
        self, Py_ssize_t part, Plan plan, State s, Rows rows, double* before, double slow
    ) noexcept nogil
    cdef void measure(self, Py_ssize_t k, Plan plan, State s, Rows rows) noexcept nogil
    @cython.locals(moves=bint)
    cdef void note_friction(
        self, Py_ssize_t part, Plan plan, State s, Rows rows, double slow
    ) noexcept nogil
    cdef double unseen(self, double h, Plan plan, State s, Rows rows) noexcept nogil
    cdef double let_go(
        self, Py_ssize_t k, double h, double apart, Plan plan, State s, Rows rows
    ) noexcept nogil
    cdef bint shares(self, Py_ssize_t k, Plan plan, State s, Rows rows) noexcept nogil
    cdef double differ(self, Py_ssize_t k) noexcept nogil
    cdef double apart_by(self, Py_ssize_t k) noexcept nogil


cdef double turned_at_rest(double u, double W, double needed, double friction) noexcept nogil
cdef Py_ssize_t moved(Indices ids, Py_ssize_t i, Py_ssize_t last, Py_ssize_t m) noexcept nogil
