from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t JUMP, OPEN
cdef double LARGE

cdef void fly(Mechanism s, Record record, Tally tally) noexcept nogil
cdef void rebase(Mechanism s, double t) noexcept nogil
cdef void state_at(Mechanism s, double tau) noexcept nogil
cdef void press(Mechanism s, double tau) noexcept nogil
cdef void synchronise(Mechanism s) noexcept nogil
cdef void polish(Mechanism s) noexcept nogil
