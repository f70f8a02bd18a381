cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, OPEN, SLIDES, STICKS

cdef void look_back(Rubbing s) noexcept nogil
cdef double recurs(Rubbing s) noexcept nogil
@cython.locals(some=bint)
cdef bint slows(Rubbing s) noexcept nogil
cdef bint rubs_on(Rubbing s, Py_ssize_t i, double ratio) noexcept nogil
cdef bint rests(Rubbing s, Py_ssize_t i, double ratio) noexcept nogil
@cython.locals(rough=bint)
cdef void sum_up(Rubbing s, Record record, Tally tally, double t, double ratio) noexcept nogil
@cython.locals(u=double)
cdef bint fades(Rubbing s) noexcept nogil
cdef void take_speeds(Rubbing s) noexcept nogil
