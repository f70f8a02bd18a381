cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t FINISHED, LCP_FAILED, NEED_LCP, NOT_FINITE
cdef double UNTOLD, CONVERGED, CANCELLED, RESOLUTION, ROUNDING, NO_APPROACH

@cython.locals(impact=bint)
cdef Py_ssize_t impulses(
    Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, double t_next, bint rebounds, bint external, bint solved
) noexcept nogil
@cython.locals(impact=bint)
cdef bint pose(Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, double t_next, bint rebounds) noexcept nogil
cdef bint leave_out_what_bears_nothing(Rows c, Py_ssize_t n_a) noexcept nogil
cdef bint loads_nothing(State s, Rows c, Py_ssize_t n_a) noexcept nogil
cdef void forget_tiny(double* rate, Py_ssize_t n) noexcept nogil
cdef double size_of_rate(Rows c, double* v, Py_ssize_t i, Py_ssize_t n_q) noexcept nogil
cdef void without_joints(bint linear, Plan plan, State s, Rows c, Py_ssize_t n_a) noexcept nogil
@cython.locals(impact=bint)
cdef bint rates(Model m, State s, Rows c, Py_ssize_t n_a, bint rebounds) noexcept nogil
@cython.locals(found=bint)
cdef bint solve(Model m, State s, Rows c, Py_ssize_t n_a, Py_ssize_t n_f, bint impact) noexcept nogil
cdef void note_sticking(State s, Rows c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void take_part(Rows c, Py_ssize_t n_a) noexcept nogil
cdef void round_off(Rows c, double* v, Py_ssize_t n_k, Py_ssize_t n_q) noexcept nogil
cdef bint usable(double* W, Py_ssize_t* ids, Py_ssize_t n_k, Py_ssize_t n) noexcept nogil
@cython.locals(found=bint)
cdef bint strikes(State s, Rows c, Py_ssize_t n_a) noexcept nogil
cdef double brought(Rows c, Py_ssize_t k) noexcept nogil
cdef double forced(State s, Rows c, Py_ssize_t i, double rate, double size_v) noexcept nogil
cdef bint apply(Plan plan, State s, Rows c, Py_ssize_t n_k) noexcept nogil
cdef void apply_once(Plan plan, State s, Rows c, Py_ssize_t n_k) noexcept nogil
