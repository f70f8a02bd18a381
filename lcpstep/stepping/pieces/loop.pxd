cimport cython
from lcpstep.kernels.course cimport Stepwise
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work


cdef class Steps(Stepwise):
    cdef public Plan plan
    cdef readonly Model m
    cdef readonly Work w
    cdef readonly Record record
    cdef bint gliding, ends, watched, asking, told
    cdef double tau
    cdef public double stop
    cdef Py_ssize_t found, own
    cpdef Py_ssize_t begin(self, double t)
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    @cython.locals(end=Py_ssize_t, code=Py_ssize_t)
    cdef Py_ssize_t move(self) noexcept nogil
    cpdef Py_ssize_t run(self, double t0, Py_ssize_t first, Py_ssize_t last)
    @cython.locals(c=Py_ssize_t, code=Py_ssize_t)
    cdef Py_ssize_t step(self, double t) noexcept nogil
    cdef Py_ssize_t piece(self, double t) noexcept nogil
    @cython.locals(pausing=bint)
    cdef Py_ssize_t struck(self, double t, Py_ssize_t c) noexcept nogil
    @cython.locals(jumps=bint)
    cdef Py_ssize_t begin_interval(self, double t) noexcept nogil
    cdef void end_interval(self, double t) noexcept nogil
    cdef Py_ssize_t cut(self, double t) noexcept nogil
    cdef bint pass_corner(self, double t) noexcept nogil
    cdef void next_forces(self, double t) noexcept nogil
    cdef Py_ssize_t begin_piece(self, double t) noexcept nogil
    cdef Py_ssize_t find(self, double t) noexcept nogil
    cdef void measure_at(self, double at, double tau) noexcept nogil
    cdef Py_ssize_t follow(self, double t) noexcept nogil
    cdef Py_ssize_t strike(self, double t, Py_ssize_t c) noexcept nogil


@cython.locals(code=Py_ssize_t)
cdef Py_ssize_t end_step(Plan plan, Work w, Record record, double t, double stop) noexcept nogil
cdef void begin_step(Model m, Plan plan, Work w) noexcept nogil
@cython.locals(known=bint)
cdef bint is_finite(Work w) noexcept nogil
