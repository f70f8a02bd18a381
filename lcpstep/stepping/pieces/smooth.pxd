cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t LANDINGS
cdef double ON_THE_SURFACE

cdef void invert(Model m, Plan plan, Work w, double rest, Py_ssize_t place) noexcept nogil
cdef void answer_forces(
    double* inverse, double* G, double* AG, double* WA, Py_ssize_t n, Py_ssize_t n_c
) noexcept nogil
@cython.locals(place=Py_ssize_t)
cdef Py_ssize_t accelerate(Model m, Plan plan, Work w) noexcept nogil
cdef bint free_acceleration(Model m, Work w, double t, double* q, double* v, double* out) noexcept nogil
cdef bint renew_forces(Model m, Plan plan, Work w, double t) noexcept nogil
cdef void mobility(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef void respond(Model m, Work w) noexcept nogil
cdef bint refactor(Model m, Work w, double t) noexcept nogil
cdef void gap_bias(Model m, Work w, double t, double* q, double* v) noexcept nogil
cdef void measure(Model m, Work w, double t) noexcept nogil
cdef void look_along(Work w, double tau) noexcept nogil
cdef bint renew_mobility(Model m, Plan plan, Work w, double t) noexcept nogil
cdef void shift(Work w, double tau) noexcept nogil
@cython.locals(landing=Py_ssize_t, closed=bint)
cdef void put_on_surface(Model m, Plan plan, Work w, double t) noexcept nogil
cdef double closed_off(Work w) noexcept nogil
@cython.locals(free=bint)
cdef void settle_state(Model m, Plan plan, Work w, double t, double* q) noexcept nogil
cdef void newton_step(Work w, double* x) noexcept nogil
cdef bint advance(Model m, Plan plan, Work w, double t, double tau) noexcept nogil
