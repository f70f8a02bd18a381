from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef double LARGE

cdef void fly(Mechanism s, Record record, Tally tally) noexcept nogil
cdef void synchronise(Mechanism s) noexcept nogil
cdef void polish(Mechanism s) noexcept nogil
