cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t FINISHED, JOINTS_FAILED, MAX_ITERATIONS, NEWTON_FAILED, NO_EVENT, NOT_FINITE, RELEASE
cdef double RESOLUTION, RESTING, UNTOLD

cdef Py_ssize_t take_step(
    Model m, Plan plan, State s, Rows c, Record record, double t, double t_next, bint external, bint solved
) noexcept nogil
cdef void predict_active(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
cdef double drifted(Model m, Plan plan, State s, Rows c, Py_ssize_t i, double t) noexcept nogil
@cython.locals(entered=bint)
cdef bint closes_again(Model m, Plan plan, State s, Rows c, double t_next) noexcept nogil
@cython.locals(hold=bint)
cdef Py_ssize_t step(
    Model m, Plan plan, State s, Rows c, double t, double t_next, bint external, bint solved
) noexcept nogil
cdef void position(Plan plan, State s) noexcept nogil
cdef bint tangent_rates(State s, Rows c, double t, double t_next) noexcept nogil
cdef void free_velocity(Model m, Plan plan, State s, double t_next) noexcept nogil
@cython.locals(released=bint)
cdef void log_events(Model m, State s, Rows c, Record record, double t_next) noexcept nogil
