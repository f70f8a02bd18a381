cimport cython
from lcpstep.events.rows.contacts cimport Contacts
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, OPEN
cdef double CHECKED

@cython.locals(some=bint)
cdef bint find_over(Contacts s) noexcept nogil
@cython.locals(slow=bint, low=bint)
cdef double time_left(Contacts s, Py_ssize_t c) noexcept nogil
cdef double where_interrupted(Contacts s, Py_ssize_t c) noexcept nogil
@cython.locals(passed_on=bint)
cdef bint interrupted(Contacts s, Py_ssize_t c, double T) noexcept nogil
@cython.locals(rubbed=bint)
cdef bint meets(Contacts s, Py_ssize_t c, Py_ssize_t k) noexcept nogil
@cython.locals(found=bint)
cdef bint passes_on(Contacts s, Py_ssize_t c) noexcept nogil
@cython.locals(fast=bint)
cdef bint awaits(Contacts s, Py_ssize_t c) noexcept nogil
cdef bint is_told(Contacts s, Py_ssize_t d) noexcept nogil
cdef bint alternates(Contacts s, Py_ssize_t c, Py_ssize_t d) noexcept nogil
cdef void take_along(Contacts s) noexcept nogil
cdef bint just_opened(Contacts s, Py_ssize_t c) noexcept nogil
@cython.locals(found=bint)
cdef bint disturbs(Contacts s) noexcept nogil
@cython.locals(held=bint, pulls=bint, pulled=bint)
cdef bint let_go_pulling(Contacts s) noexcept nogil
cdef void find_stop(Contacts s) noexcept nogil
@cython.locals(low=bint)
cdef bint throws_off(Contacts s) noexcept nogil
cdef bint drives_others(Contacts s) noexcept nogil
cdef void tell_over(Contacts s, Record record, Tally tally, Py_ssize_t c) noexcept nogil
