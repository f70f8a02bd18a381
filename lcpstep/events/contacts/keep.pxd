cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t LEANS, OPEN, RELEASE, REVERSE, SLIDES, SLIP, STAYS_CLOSED, STICK_TANGENT, STICKS

cdef void keep(Rubbing s, Record record, double t, double* y) noexcept nogil
cdef void pay(Rubbing s, Py_ssize_t c) noexcept nogil
cdef void put_on_account(Rubbing s) noexcept nogil
cdef void keep_event(Rubbing s, Record record, double t) noexcept nogil
cdef void tell(Rubbing s, Record record, Tally tally, double t) noexcept nogil
cdef bint turned(Rubbing s, Py_ssize_t c) noexcept nogil
