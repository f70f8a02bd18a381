from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t FOLLOWED

cdef void prepare(Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, double t_next) noexcept nogil
cdef void rows_at_the_end(Model m, State s, Rows c, Py_ssize_t n_a, double t) noexcept nogil
cdef void respond(bint linear, Plan plan, State s, Rows c, Py_ssize_t n_k) noexcept nogil
cdef void refit(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
cpdef void constant_rows(Model m, Plan plan, State s, Rows c, double t) noexcept nogil
