from lcpstep.events.friction.state cimport Rubbing

cdef double SAME, DEPENDENT, TOLD, TURNED

cdef void leave_joints(Rubbing s) noexcept nogil
cdef void sweep(Rubbing s, Py_ssize_t j) noexcept nogil
cdef void respond_on_joints(Rubbing s, Py_ssize_t i) noexcept nogil
cdef bint can_bear(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint rubs(Rubbing s, Py_ssize_t c) noexcept nogil
cdef double acceleration_on_joints(Rubbing s, Py_ssize_t i) noexcept nogil
