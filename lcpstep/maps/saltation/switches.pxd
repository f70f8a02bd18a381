cimport cython
from lcpstep.events.hybrid.field cimport Machine
from lcpstep.kernels.rungekutta cimport RungeKutta
from lcpstep.pointers cimport Doubles

cdef Py_ssize_t DONE, NOT_TRANSVERSAL, VECTORS
cdef double TOLERANCE, RELATIVE_STEP


cdef class Tangent(RungeKutta):
    cdef object squares, vectors
    cdef readonly object derivative
    cdef readonly Machine m
    cdef Py_ssize_t n_x, mode
    cdef Doubles J, F_x, S, R, R_t, H_x, x, start, F_before, F_after, up, down
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil


cdef Py_ssize_t walk(
    Tangent s, double* log, Py_ssize_t count, Py_ssize_t mode, double t, double* x, double t_end
) noexcept nogil
cdef void unit(double* J, Py_ssize_t n) noexcept nogil
cdef void times(Tangent s, double* D) noexcept nogil
cdef Py_ssize_t flow(Tangent s, double a, double b) noexcept nogil
cdef void variation(Tangent s, double t, double* z, double* out) noexcept nogil
cdef bint switch(Tangent s, double* lines, Py_ssize_t further, bint moves) noexcept nogil
cdef void compose(Tangent s, double* line, double t) noexcept nogil
cdef void product(Tangent s) noexcept nogil
cdef void differenced(Tangent s, Py_ssize_t guard, double t, double* x, Py_ssize_t j, double d) noexcept nogil
cdef void put_on_surface(Tangent s, double t) noexcept nogil
