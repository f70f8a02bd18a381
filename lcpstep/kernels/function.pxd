cimport cython
from lcpstep.pointers cimport Callback


@cython.final
cdef class Function:
    cdef object kept
    cdef Callback f
    cdef double* p
    cdef Py_ssize_t[5] sizes
    cdef Py_ssize_t length
    cdef readonly bint given
    cdef readonly Py_ssize_t address
    cdef void fill(self, double t, double* q, double* v, double* out) noexcept nogil


@cython.final
cdef class Functions:
    cdef object array
    cdef Function like
    cdef Py_ssize_t* addresses
    cdef Py_ssize_t length
    cdef void fill(self, Py_ssize_t k, double t, double* q, double* v, double* out) noexcept nogil
