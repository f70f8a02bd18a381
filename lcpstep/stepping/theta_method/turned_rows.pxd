cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.constraints.joint_rows cimport Elimination
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef double LANDED
cdef Py_ssize_t LANDINGS

cdef void sweep_out_turned(
    Elimination e, bint linear, Plan plan, State s, Rows c, Py_ssize_t n, Py_ssize_t n_k
) noexcept nogil
cdef bint nearly_held(Plan plan, Rows c, Py_ssize_t k, Py_ssize_t n) noexcept nogil
@cython.locals(some=bint)
cdef bint put_rows_on_joints(
    Elimination e, Model m, Plan plan, State s, Rows c, Py_ssize_t n_a, Py_ssize_t n, double t
) noexcept nogil
cdef bint land_on_joints(Elimination e, Plan plan, State s, Rows c, Py_ssize_t first, double t) noexcept nogil
cdef void transpose(Elimination e) noexcept nogil
