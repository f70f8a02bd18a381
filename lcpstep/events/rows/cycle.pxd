cimport cython
from lcpstep.events.rows.contacts cimport Contacts
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, OPEN, SLIDES, STICKS

cdef void look_back(Contacts s) noexcept nogil
cdef double recurs(Contacts s) noexcept nogil
@cython.locals(some=bint)
cdef bint slows(Contacts s) noexcept nogil
cdef bint rubs_on(Contacts s, Py_ssize_t i, double ratio) noexcept nogil
cdef bint rests(Contacts s, Py_ssize_t i, double ratio) noexcept nogil
@cython.locals(rough=bint)
cdef void sum_up(Contacts s, Record record, Tally tally, double ratio) noexcept nogil
@cython.locals(u=double)
cdef bint fades(Contacts s) noexcept nogil
