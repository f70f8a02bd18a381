cimport cython
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t ALL, STAGES, EXTRA_STAGES, DONE, NOT_FINITE, STEP_TOO_SMALL, HOPELESS, POLYNOMIALS, NEEDED_LATER
cdef double UNDERFLOW, SAFETY, LEAST, MOST, STRETCH, TOLERANCES, LOOK, DEFECT, UNLIKE, UNSEEN, FALLS, LATE, SHORT, ROUNDINGS


cdef class RungeKutta:
    cdef object tables, numbers
    cdef readonly object state
    cdef readonly Py_ssize_t n, positions
    cdef readonly bint dense
    cdef public double rtol, atol, length, next_step
    cdef public Py_ssize_t evaluations
    cdef Py_ssize_t refused, stage
    cdef double stretch_end
    cdef Indices needed
    cdef Doubles A, C, D, E3, E5, y, y_new, y_stage, first, K, F
    cdef bint rates(self, double t, double* y, double* dy) noexcept nogil
    cdef double rate_terms(self) noexcept nogil
    cdef void begin(self, double next_step) noexcept nogil
    @cython.locals(truncated=bint, again=bint, good=bint, known=bint, error=double)
    cdef Py_ssize_t take_step(self, double t, double longest, double scan) noexcept nogil
    cdef bint step(self, double t, double h) noexcept nogil
    cdef double meet(self, double t, double tau, double most, double far, Py_ssize_t tries) noexcept nogil
    cdef double miss(self, double t, double tau) noexcept nogil
    cdef bint complete(self, double t, double h) noexcept nogil
    cdef bint stages(self, double t, double h, Py_ssize_t first, Py_ssize_t end) noexcept nogil
    cdef void combine(self, double h, Py_ssize_t stage) noexcept nogil
    cdef double error_norm(self, double h) noexcept nogil
    cdef double unresolved(self, double h, double error) noexcept nogil
    cdef bint refuse(self, double t, double scan) noexcept nogil
    cdef bint repeats(self, double h) noexcept nogil
    cdef void interpolant(self, double h) noexcept nogil
    cdef double dense_error(self, double h) noexcept nogil
    cdef void at(self, double x, double* out) noexcept nogil


@cython.locals(a=double, b=double)
cdef (double, double) weigh(double* w, double* K, Py_ssize_t n, Py_ssize_t first, Py_ssize_t end) noexcept nogil
cdef double factor(double error) noexcept nogil
