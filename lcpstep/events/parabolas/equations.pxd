from lcpstep.events.parabolas.state cimport Mechanism

cdef bint measure(Mechanism s, double t) noexcept nogil
cdef void measure_gaps(Mechanism s, double t) noexcept nogil
cdef double gap_tolerance(Mechanism s, Py_ssize_t c) noexcept nogil
cdef double speed_tolerance(Mechanism s, Py_ssize_t c) noexcept nogil
