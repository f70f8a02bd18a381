cdef class Log:
    cdef readonly object times, impulses, jumps, contacts, kinds
    cdef readonly Py_ssize_t n
    cdef readonly double end
    cdef Doubles time, impulse, jump
    cdef Indices contact, kind
