cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Plan, State

cdef double DIFFERENCE, SLOW, FAR
cdef Py_ssize_t REFRESH

@cython.locals(fresh=bint, given=bint)
cdef bint linearise(Model m, Plan plan, State s, double t, double t_next) noexcept nogil
cdef double least_speed(State s, double h) noexcept nogil
cdef void residual(Model m, Plan plan, State s, double t_next, double* v) noexcept nogil
cdef void given_jacobian(Model m, Plan plan, State s, double t_next) noexcept nogil
cdef void compliance(bint linear, Plan plan, State s, double* row, double* out) noexcept nogil
