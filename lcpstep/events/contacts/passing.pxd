from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ALL, STAGES

cdef void take_over(Rubbing s, Record record, Tally tally, double t, double tau) noexcept nogil
cdef void keep_wanted(Rubbing s, Record record, double tau) noexcept nogil
cdef void press_between(Rubbing s, double a, double b) noexcept nogil
cdef void press_rest(Rubbing s, double a, double b) noexcept nogil
cdef bint sum_up(Rubbing s) noexcept nogil
