cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t OPEN, SLIDES

cdef bint close_chatter(Mechanism s, Record record, Tally tally) noexcept nogil
cdef void hand_on(Mechanism s) noexcept nogil
