from lcpstep.events.flight.motion cimport Flight
from lcpstep.kernels.record cimport Record

cdef Py_ssize_t IMPACT, STICK

cdef void begin_tangent(double* J) noexcept nogil
cdef void clear_tangent(double* J, double x) noexcept nogil
cdef void carry(Flight s, double* J, double tau) noexcept nogil
cdef void strike(Flight s, double* J, double t, double u) noexcept nogil
cdef double along_events(Flight s, Record record, double* J, double last) noexcept nogil
cpdef object along_logs(Flight s, object log, object counts, double t_start, double t_end, object out)
cdef void along_log(
    Flight s, double* log, Py_ssize_t n, Py_ssize_t most, bint landed, double t_start, double t_end, double* J
) noexcept nogil
