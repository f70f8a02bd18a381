cimport cython

from lcpstep.kernels.dynamics cimport gap_rates
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport abs, max, min
from lcpstep.stepping.pieces.codes cimport (
    AGAIN,
    CLOSED, CORNER, EPS, FINISHED, GROUND, LCP_FAILED, LEFT, NOBODY, NOT_FINITE, ROUNDING, SAME_TIME,
)
from lcpstep.stepping.pieces.impulses cimport strike
from lcpstep.stepping.pieces.keep cimport keep
from lcpstep.stepping.pieces.loop cimport Steps, is_finite
from lcpstep.stepping.pieces.magnitudes cimport acceleration_terms, speed_terms
from lcpstep.stepping.pieces.piece cimport penetrates
from lcpstep.stepping.pieces.polynomial cimport (
    NODES, WEIGHTS, Polynomial, acceleration, biases, expand, force_at, on_surface, state_at,
)
from lcpstep.stepping.pieces.polynomial_forces cimport UNDECIDED, load
from lcpstep.stepping.pieces.scan cimport LOW, NOWHERE, first_landing, first_release, hop_at, is_low
from lcpstep.stepping.pieces.smooth cimport measure, newton_step, put_on_surface, refactor, respond, settle_state
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport idle, release, stick, turn
from lcpstep.stepping.pieces.times cimport at_corner, within

cdef double SLOW


cdef class PolynomialSteps(Steps):
    cdef readonly Polynomial z
    cdef bint opens
    cdef Py_ssize_t begin_piece(self, double t) noexcept nogil
    @cython.locals(landing=Py_ssize_t)
    cdef Py_ssize_t find(self, double t) noexcept nogil
    cdef Py_ssize_t follow(self, double t) noexcept nogil
    cdef Py_ssize_t strike(self, double t, Py_ssize_t c) noexcept nogil


cdef bint too_short(Plan plan, Work w, double now) noexcept nogil
cdef void lose_force(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
cdef Py_ssize_t follow(
    Model m, Plan plan, Work w, Polynomial z, Record record, double t, double tau, bint ends
) noexcept nogil
cdef double carried(
    Model m, Plan plan, Work w, Polynomial z, double t, double tau, Py_ssize_t c
) noexcept nogil
cdef void slide(Model m, Work w, double t) noexcept nogil
@cython.locals(again=bint)
cdef Py_ssize_t touch(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
