from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t FINISHED, LCP_FAILED, PROJECTION_FAILED, PROJECTIONS

cdef Py_ssize_t project(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
cdef bint correct(Model m, State s, Rows c, double t, bint astray) noexcept nogil
cdef void without_joints(State s, Rows c, Py_ssize_t n_a) noexcept nogil
cdef Py_ssize_t leave_out_nearly_held(Rows c, Py_ssize_t n_a) noexcept nogil
