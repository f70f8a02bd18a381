cimport cython
from libc.math cimport pow
from lcpstep.kernels.dynamics cimport gap_rates
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport product
from lcpstep.pointers cimport abs, max, min
from lcpstep.stepping.pieces.codes cimport (
    ACCUMULATION, CLOSED, FINISHED, GROUND, IMPACT, INERTIA, LCP_FAILED, NOT_FINITE, ROUNDING
)
from lcpstep.stepping.pieces.jointed cimport answer_impulse, hold_joints, turn_with_joints
from lcpstep.stepping.pieces.keep cimport keep
from lcpstep.stepping.pieces.magnitudes cimport speed_terms
from lcpstep.stepping.pieces.refine cimport NONE, solve_chosen
from lcpstep.stepping.pieces.smooth cimport (
    gap_bias, measure, put_on_surface, refactor, renew_forces, respond
)
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport release, stick
from lcpstep.stepping.pieces.times cimport within

cdef double UNTOLD

cdef bint endless(Plan plan, Work w) noexcept nogil
cdef Py_ssize_t settle(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
cdef bint meet(Model m, Plan plan, Work w, double t, double span) noexcept nogil
@cython.locals(some=bint, elastic=bint)
cdef bint matters(Model m, Work w, bint lasting) noexcept nogil
@cython.locals(closed=bint, pressed=bint, touches=bint)
cdef void note(
    Model m, Plan plan, Work w, Record record, double start, double end, double span
) noexcept nogil
cdef Py_ssize_t begin_again(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
