from lcpstep.events.flight.motion cimport Flight


cdef void keep(Flight s, double t) noexcept nogil
cdef void keep_times(Flight s, double stop, bint last) noexcept nogil
cdef void keep_event(Flight s) noexcept nogil
cpdef object evaluate(Flight s, object kept, object times, object row, object q, object v)
cdef void fly_on(Flight s, double start, double t) noexcept nogil
