cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.theta_method.moving cimport Plan, Rows, State

cdef Py_ssize_t EVENTS, IMPACT, NO_EVENT, RELEASE, STICK
cdef double RESOLUTION, RESTING, UNTOLD

cdef void in_registers(
    Model m, Plan plan, State s, Rows c, Record record, double t0, Py_ssize_t first, Py_ssize_t last, bint external
) noexcept nogil
@cython.locals(driven=bint, moving=bint)
cdef void coast(
    Model m, Plan plan, State s, Record record, double t0, Py_ssize_t first, Py_ssize_t last
) noexcept nogil
@cython.locals(driven=bint, moving=bint)
cdef void press(
    Model m, Plan plan, State s, Rows c, Record record, double t0, Py_ssize_t first, Py_ssize_t last
) noexcept nogil
cdef double met(
    Model m, Plan plan, State s, Rows c, Record record, double t, Py_ssize_t k, double q, double g, double u, double v
) noexcept nogil
cdef Py_ssize_t kind_of(double p, Py_ssize_t closed) noexcept nogil
cdef Py_ssize_t closed_since(double p, Py_ssize_t closed) noexcept nogil
