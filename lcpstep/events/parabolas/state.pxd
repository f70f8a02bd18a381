cdef class Mechanism(Contacts):
    cdef object numbers
    cdef readonly object state
    cdef readonly Py_ssize_t n_members
    cdef double length
    cdef bint bare
    cdef Doubles q0, v0, lift, synchronous
