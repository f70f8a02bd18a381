cimport cython
from lcpstep.kernels.linear cimport solve_factored
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport clear, copy, product
from lcpstep.pointers cimport abs, after, max, min
from lcpstep.stepping.pieces.codes cimport CLOSED, GROUND, INERTIA, LEFT, OPEN, ROUNDING
from lcpstep.stepping.pieces.jointed cimport answer_force
from lcpstep.stepping.pieces.magnitudes cimport acceleration_terms, speed_terms
from lcpstep.stepping.pieces.refine cimport FORCES, IMPULSES, keep_closed, solve_chosen
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.switches cimport release, release_time, stick, turn

cdef bint hold(Model m, Plan plan, Work w, Record record, Py_ssize_t place, double t) noexcept nogil
cdef Py_ssize_t answered(Plan plan, Work w, Py_ssize_t place) noexcept nogil
@cython.locals(closed=bint)
cdef Py_ssize_t choose_resting(Work w) noexcept nogil
cdef double leaving(Model m, Work w, double* W, Py_ssize_t k, Py_ssize_t n_k) noexcept nogil
cdef bint pulls(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef double force_rounding(Model m, Work w, Py_ssize_t c) noexcept nogil
cdef double jerked(Work w, double* W, Py_ssize_t c) noexcept nogil
@cython.locals(more=bint)
cdef double largest_connected(Work w, Py_ssize_t c) noexcept nogil
cdef void zero_rounding(Plan plan, Work w) noexcept nogil
cdef bint land(Model m, Plan plan, Work w, Record record, double t, double tau) noexcept nogil
