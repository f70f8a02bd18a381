
cdef class Function:
    cdef object kept
    cdef Callback f
    cdef Doubles p
    cdef Py_ssize_t[5] sizes
    cdef Py_ssize_t length
    cdef readonly bint given
    cdef readonly Py_ssize_t address

cdef class Functions:
    cdef object array
    cdef Function like
    cdef Indices addresses
    cdef Py_ssize_t length
