from lcpstep.kernels.acceleration cimport factor_mass, response
from lcpstep.kernels.dynamics cimport gap_rates, gaps
from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport abs, after, inf, max
from lcpstep.kernels.coulomb cimport solve_contacts
from lcpstep.stepping.constraints.directions cimport mobilities
from lcpstep.stepping.constraints.joint_rows cimport arrived, distribute, eliminate
from lcpstep.stepping.theta_method.moving cimport Rows, State
from lcpstep.stepping.theta_method.plan cimport Plan

cdef Py_ssize_t FINISHED, LCP_FAILED, PROJECTION_FAILED, PROJECTIONS

cdef Py_ssize_t project(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
cdef bint correct(Model m, State s, Rows c, double t) noexcept nogil
