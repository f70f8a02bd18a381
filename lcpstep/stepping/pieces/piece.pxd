cimport cython
from lcpstep.kernels.dynamics cimport gap_rounding, gaps, moves, obstacle
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.quadratic cimport first_zero, may_reach_zero
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport abs, after, max, min
from lcpstep.stepping.pieces.codes cimport (
    CLOSED, EPS, FINISHED, LCP_FAILED, LEFT, NOBODY, NOT_FINITE, OPEN, SAME_TIME,
)
from lcpstep.stepping.pieces.contact_forces cimport hold, land
from lcpstep.stepping.pieces.jointed cimport load_joints, put_on_joints, share_out
from lcpstep.stepping.pieces.keep cimport keep_between, keep_times, remember
from lcpstep.stepping.pieces.smooth cimport (
    ON_THE_SURFACE, accelerate, advance, gap_bias, measure, put_on_surface, refactor, respond,
)
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport stick
from lcpstep.stepping.pieces.times cimport driven_by, within

cdef Py_ssize_t POLISHING
cdef double BRIEF

@cython.locals(closed=bint)
cdef bint begin_piece(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
cdef void flat_accelerations(Model m, Plan plan, Work w, double t) noexcept nogil
cdef void pressed(Plan plan, Work w, Py_ssize_t place) noexcept nogil
cdef void fitted(Model m, Plan plan, Work w, double t, double rest) noexcept nogil
@cython.locals(some=bint)
cdef bint needs_bias(Plan plan, Work w) noexcept nogil
cdef bint from_ground(Plan plan, Work w, Py_ssize_t c) noexcept nogil
@cython.locals(found=Py_ssize_t)
cdef (Py_ssize_t, double) first_contact(Plan plan, Work w, double rest, double t_end) noexcept nogil
@cython.locals(falls=bint, near=bint)
cdef (Py_ssize_t, double) polish(
    Model m, Plan plan, Work w, Py_ssize_t c, double t, double tau, double rest
) noexcept nogil
cdef void look(Model m, Plan plan, Work w, double t, double tau) noexcept nogil
cdef double between(
    Model m, Plan plan, Work w, Py_ssize_t c, double t, double low, double high
) noexcept nogil
@cython.locals(wanted=bint, taken=bint)
cdef Py_ssize_t move(Model m, Plan plan, Work w, Record record, double t, double tau, bint to_end) noexcept nogil
@cython.locals(taken=bint)
cdef bint take_back(Plan plan, Work w, Record record, double t) noexcept nogil
cdef bint penetrates(Plan plan, Work w) noexcept nogil
