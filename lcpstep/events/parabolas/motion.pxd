from lcpstep.events.parabolas.state cimport Mechanism

cdef void rebase(Mechanism s, double t) noexcept nogil
cdef void state_at(Mechanism s, double tau) noexcept nogil
cdef double rounding_of_gap(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void press(Mechanism s, double tau) noexcept nogil
