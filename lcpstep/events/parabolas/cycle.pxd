cimport cython
from lcpstep.events.parabolas.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION

cdef void look_back(Mechanism s) noexcept nogil
@cython.locals(touches=bint)
cdef double recurrence(Mechanism s) noexcept nogil
cdef void sum_up(Mechanism s, Record record, Tally tally, double ratio) noexcept nogil
cdef bint fades(Mechanism s) noexcept nogil
