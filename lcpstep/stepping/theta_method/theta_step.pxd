cimport cython
from lcpstep.kernels.dynamics cimport external_force, gap_rates, gaps
from lcpstep.kernels.linear cimport solve
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.vectors cimport clear, copy, finite, product
from lcpstep.pointers cimport after
from lcpstep.stepping.constraints.coulomb cimport solve_contacts
from lcpstep.stepping.constraints.directions cimport (
    apply,
    average,
    joints_hold,
    mobilities,
    position,
    rates,
    restitute,
    strikes,
    take_part,
    usable,
)
from lcpstep.stepping.constraints.joint_rows cimport distribute, eliminate
from lcpstep.stepping.theta_method.implicit cimport linearise
from lcpstep.stepping.theta_method.moving cimport Rows, State
from lcpstep.stepping.theta_method.plan cimport Plan
from lcpstep.stepping.theta_method.repair cimport project

cdef Py_ssize_t FINISHED, IMPACT, JOINTS_FAILED, LCP_FAILED, NEED_LCP, NEWTON_FAILED, NOT_FINITE, RELEASE, STICK
cdef Py_ssize_t MAX_ITERATIONS, REFRESH

cdef Py_ssize_t take_step(
    Model m, Plan plan, State s, Rows c, Record record, double t, double t_next, bint external, bint solved
) noexcept nogil
cdef Py_ssize_t predict_active(Plan plan, State s, Rows c) noexcept nogil
@cython.locals(entered=bint)
cdef Py_ssize_t closes_again(Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, double t_next) noexcept nogil
@cython.locals(converged=bint, hold=bint)
cdef Py_ssize_t step(
    Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, double t, double t_next, bint external, bint solved
) noexcept nogil
cdef void predicted_rates(Model m, Plan plan, State s, Rows c, double t_next) noexcept nogil
cdef void tangent_rates(State s, Rows c, double t, double t_next) noexcept nogil
cdef void free_velocity(Model m, Plan plan, State s, double t_next) noexcept nogil
@cython.locals(impact=bint)
cdef Py_ssize_t impulses(
    Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, Py_ssize_t n_f, double t_next, bint external, bint solved
) noexcept nogil
cdef void respond(bint linear, Plan plan, State s, Rows c, Py_ssize_t n_k) noexcept nogil
cdef void compliance(bint linear, Plan plan, State s, double* row, double* out) noexcept nogil
cdef void constant_rows(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
cdef void log_events(Model m, State s, Rows c, Record record, double t_next) noexcept nogil
