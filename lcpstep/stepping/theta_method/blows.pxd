cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.theta_method.moving cimport Blows, Plan, Rows, State

cdef Py_ssize_t FINISHED, NEED_LCP
cdef Py_ssize_t TURNS
cdef double LEFT, RESOLUTION

@cython.locals(opens=double, closes=double)
cdef bint separates(Plan plan, State s, Rows c, Blows b, Py_ssize_t n_a) noexcept nogil
cdef Py_ssize_t one_after_another(
    Model m, Plan plan, State s, Rows c, Blows b, double t_next, bint external, bint solved
) noexcept nogil
cdef bint choose(State s, Rows c, Blows b) noexcept nogil
cdef void all_of_them(State s, Rows c, Blows b) noexcept nogil
cdef void after_blow(Plan plan, State s, Rows c, Blows b) noexcept nogil
cdef double unmoved(Plan plan, State s, Rows c, Py_ssize_t i) noexcept nogil
