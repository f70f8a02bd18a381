cimport cython
from lcpstep.events.rows.state cimport Rows
from lcpstep.kernels.rungekutta cimport RungeKutta

cdef double TOLERANCES

cdef bint breaks(Rows s, RungeKutta motion, double h, bint measured) noexcept nogil
@cython.locals(found=Py_ssize_t)
cdef Py_ssize_t farthest_off(Rows s, RungeKutta motion) noexcept nogil
@cython.locals(driven=bint)
cdef bint drive_joints(Rows s, double* v) noexcept nogil
cdef Py_ssize_t open_at(Rows s, double t, RungeKutta motion) noexcept nogil
cdef bint find_way(Rows s, RungeKutta motion, Py_ssize_t i, double h) noexcept nogil
cdef bint go_beyond(Rows s, double* q, double* v) noexcept nogil
cdef double unseen(Rows s, Py_ssize_t i, double* v) noexcept nogil
cdef double error(Rows s, Py_ssize_t i, double* v) noexcept nogil
cdef double velocity(Rows s, Py_ssize_t i, double t, double* y) noexcept nogil
@cython.locals(beyond=bint, coarse=double)
cdef double hidden_by_rounding(Rows s, RungeKutta motion, Py_ssize_t i) noexcept nogil
cdef bint find_jump(Rows s, RungeKutta motion, Py_ssize_t i, double h) noexcept nogil
