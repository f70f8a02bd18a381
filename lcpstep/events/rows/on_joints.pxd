cimport cython
from lcpstep.events.rows.state cimport Rows

cdef double SAME, DEPENDENT, TOLD, TURNED

cdef void leave_joints(Rows s) noexcept nogil
cdef void leave_joints_again(Rows s, Py_ssize_t count) noexcept nogil
cdef void couple_on_joints(Rows s, Py_ssize_t i, Py_ssize_t k) noexcept nogil
cdef void put_on_joints(Rows s, Py_ssize_t i) noexcept nogil
cdef double acceleration_on_joints(Rows s, Py_ssize_t i, double* a) noexcept nogil
cdef bint can_bear(Rows s, Py_ssize_t c) noexcept nogil
