from lcpstep.events.general.chatter cimport stop
from lcpstep.events.general.impact cimport apply, speed_noise
from lcpstep.events.general.keep cimport log
from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.pointers cimport abs, max

cdef Py_ssize_t ACCUMULATION
cdef double RETURNS, FOR_EVER

cdef void look_back(Mechanism s) noexcept nogil
cdef double recurrence(Mechanism s) noexcept nogil
cdef void sum_up(Mechanism s, Record record, Tally tally, double ratio) noexcept nogil
