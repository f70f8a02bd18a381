cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.turn cimport Turn
from lcpstep.pointers cimport Doubles
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t DEGREE, QUINTIC, PROBES, CORRECTIONS
cdef double DOUBTFUL
cdef double[4] NODES, WEIGHTS


@cython.final
cdef class Polynomial:
    cdef readonly object kept
    cdef readonly double scale
    cdef readonly Py_ssize_t degree
    cdef Doubles T, a, q, v, q_stage, v_stage, q_end, v_end, gap_from, rate_from, gap_to, rate_to, rate_now, pressed
    cdef Turn turn


cdef bint on_surface(Plan plan, Work w) noexcept nogil
cdef bint acceleration(Model m, Plan plan, Work w, double t, double* q, double* v, double* out) noexcept nogil
cdef void biases(Model m, Work w, double t, double* q, double* v) noexcept nogil
cdef bint constrained(Model m, Plan plan, Work w, double t, double* q, double* v, double* out) noexcept nogil
cdef void factor_closed(Work w) noexcept nogil
cdef void press(Work w, double* out, double share) noexcept nogil
cdef void add_forces(Work w, double* out, Py_ssize_t n_k) noexcept nogil
cdef bint expand(Model m, Plan plan, Work w, Polynomial z, double t, double length) noexcept nogil
@cython.locals(moves=bint, quiet=Py_ssize_t)
cdef bint taylor(Model m, Plan plan, Work w, Polynomial z, double t) noexcept nogil
@cython.locals(good=bint)
cdef bint hermite(Model m, Plan plan, Work w, Polynomial z, double t, double L) noexcept nogil
cdef void state_at(Model m, Plan plan, Work w, Polynomial z, double t, double tau) noexcept nogil
cdef void surface_state(Model m, Work w, Polynomial z, double t) noexcept nogil
cdef void contacts_at(
    Model m, Plan plan, Work w, Polynomial z, double t, double tau, double* g, double* u
) noexcept nogil
cdef bint force_at(Model m, Plan plan, Work w, Polynomial z, double t, double tau) noexcept nogil
