from lcpstep.events.flight.motion cimport Flight

cdef Py_ssize_t PROBES, NODES
cdef double NONE, RESOLUTION
cdef double[8] NODE
cdef double[8] WEIGHT

cdef double alpha_at(Flight s, double t) noexcept nogil
cdef double contact_impulse(Flight s, double a, double b) noexcept nogil
cdef double first_release(Flight s, double a, double alpha_a, double b) noexcept nogil
cdef double last_release(Flight s, double a, double f_a, double b, double f_b) noexcept nogil
cdef double alpha_root(Flight s, double a, double f_a, double b, double f_b) noexcept nogil
cdef (double, double) summit(
    Flight s, double t_1, double h, double f_0, double f_1, double f_2
) noexcept nogil
