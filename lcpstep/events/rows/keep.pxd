cimport cython
from lcpstep.events.rows.contacts cimport Contacts
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t LEANS, OPEN, RELEASE, REVERSE, SLIDES, SLIP, STAYS_CLOSED, STICK_TANGENT, STICKS

cdef void keep(Contacts s, Record record, double t, double* y) noexcept nogil
cdef void pay(Contacts s, Py_ssize_t c) noexcept nogil
cdef void put_on_account(Contacts s) noexcept nogil
cdef void keep_event(Contacts s, Record record, double t) noexcept nogil
@cython.locals(some=bint)
cdef bint tell(Contacts s, Record record, Tally tally, double t) noexcept nogil
cdef bint turned(Contacts s, Py_ssize_t c) noexcept nogil
