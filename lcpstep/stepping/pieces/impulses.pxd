cimport cython
from lcpstep.kernels.dynamics cimport gap_rounding, order_matters
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.pointers cimport abs, max, min
from lcpstep.stepping.pieces.codes cimport (
    ACCUMULATION, CLOSED, CORNER, GROUND, IMPACT, INERTIA, LEFT, OPEN, ROUNDING
)
from lcpstep.stepping.pieces.corners cimport choose_jumping
from lcpstep.stepping.pieces.jointed cimport answer_impulse
from lcpstep.stepping.pieces.magnitudes cimport faint, speed_terms
from lcpstep.stepping.pieces.refine cimport NONE, solve_chosen
from lcpstep.stepping.pieces.smooth cimport ON_THE_SURFACE
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport (
    AT_ONCE_FAST, COLLAPSE, SHORT_TOGETHER, idle, release, stick, turn,
)
from lcpstep.stepping.pieces.times cimport driven_by

cdef double SHORT, SAME_SPEED, SMALL
cdef Py_ssize_t IN_A_ROW, MANY_AT_ONCE

cdef Py_ssize_t strike(Model m, Plan plan, Work w, Record record, Py_ssize_t first, double t) noexcept nogil
@cython.locals(x=double, fine=double)
cdef void measure_rates(Work w) noexcept nogil
@cython.locals(touched=bint, closing=bint, near=bint, pushed=bint, alike=bint)
cdef Py_ssize_t choose_struck(Model m, Plan plan, Work w, Py_ssize_t first) noexcept nogil
cdef bint tied(Model m, Plan plan, Work w, Py_ssize_t first, Py_ssize_t c) noexcept nogil
cdef bint at_this_instant(Plan plan, Work w, Py_ssize_t c) noexcept nogil
cdef Py_ssize_t choose_connected(Work w, Py_ssize_t n_s) noexcept nogil
cdef void note_hit(Plan plan, Work w, Py_ssize_t c) noexcept nogil
@cython.locals(ends_in_time=bint)
cdef bint closes(Model m, Plan plan, Work w, Py_ssize_t c, bint alone, double t) noexcept nogil
cdef bint unresolved(Plan plan, Work w, Py_ssize_t c, double hop, double t) noexcept nogil
cdef double jump(Plan plan, Work w, Py_ssize_t n_s) noexcept nogil
@cython.locals(touches=bint)
cdef void push(Plan plan, Work w, Py_ssize_t d, double p) noexcept nogil
cdef void after_impact(
    Model m, Plan plan, Work w, Record record, Py_ssize_t c, double p, double t
) noexcept nogil
