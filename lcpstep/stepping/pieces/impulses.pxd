cimport cython
from lcpstep.kernels.dynamics cimport gap_rounding, order_matters
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport clear
from lcpstep.pointers cimport abs, max, min
from lcpstep.stepping.pieces.codes cimport (
    ACCUMULATION, CLOSED, CORNER, GROUND, IMPACT, INERTIA, LEFT, OPEN, ROUNDING
)
from lcpstep.stepping.pieces.corners cimport choose_jumping
from lcpstep.stepping.pieces.jointed cimport answer_impulse
from lcpstep.stepping.pieces.magnitudes cimport speed_terms
from lcpstep.stepping.pieces.refine cimport NONE, solve_chosen
from lcpstep.stepping.pieces.sequences cimport (
    IN_A_ROW, MANY_AT_ONCE, at_this_instant, choose_collapsing, choose_connected, closes, measure_rates, note_hit,
)
from lcpstep.stepping.pieces.smooth cimport ON_THE_SURFACE
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport idle, release, stick, turn

cdef double SAME_SPEED, SMALL

@cython.locals(collapsed=bint, together=Py_ssize_t)
cdef Py_ssize_t strike(Model m, Plan plan, Work w, Record record, Py_ssize_t first, double t) noexcept nogil
@cython.locals(touched=bint, closing=bint, near=bint, pushed=bint, alike=bint)
cdef Py_ssize_t choose_struck(Model m, Plan plan, Work w, Py_ssize_t first) noexcept nogil
cdef bint tied(Model m, Plan plan, Work w, Py_ssize_t first, Py_ssize_t c) noexcept nogil
cdef double jump(Plan plan, Work w, Py_ssize_t n_s) noexcept nogil
@cython.locals(touches=bint)
cdef void push(Plan plan, Work w, Py_ssize_t d, double p) noexcept nogil
cdef void after_impact(
    Model m, Plan plan, Work w, Record record, Py_ssize_t c, double p, double t
) noexcept nogil
