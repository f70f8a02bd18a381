from lcpstep.kernels.linear cimport grow_factor, solve_factored
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport product
from lcpstep.pointers cimport abs, after, max
from lcpstep.stepping.pieces.codes cimport CORNER, FINISHED, GROUND, LCP_FAILED, NOT_FINITE, OPEN, ROUNDING
from lcpstep.stepping.pieces.impulses cimport strike
from lcpstep.stepping.pieces.keep cimport keep
from lcpstep.stepping.pieces.magnitudes cimport speed_terms
from lcpstep.stepping.pieces.smooth cimport mobility, refactor, renew_forces, respond
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport idle, stick, turn

cdef Py_ssize_t event(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
cdef void lift(Model m, Plan plan, Work w, double* x, Py_ssize_t c, double distance) noexcept nogil
cdef void straighten(Model m, Plan plan, Work w, Py_ssize_t d) noexcept nogil
cdef void straighten_all(Model m, Work w, Py_ssize_t n_s) noexcept nogil
cdef double height(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef void remeasure(Model m, Plan plan, Work w) noexcept nogil
