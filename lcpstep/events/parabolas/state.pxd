from lcpstep.events.rows.contacts cimport Contacts
from lcpstep.pointers cimport Doubles


cdef class Mechanism(Contacts):
    cdef object numbers
    cdef readonly object state
    cdef readonly Py_ssize_t n_members, evaluations
    cdef double length
    cdef bint bare
    cdef Doubles q0, v0, lift, synchronous
    cdef void move(self, Py_ssize_t i, double p) noexcept nogil
    cdef void halt(self) noexcept nogil
