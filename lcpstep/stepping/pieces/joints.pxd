cimport cython


@cython.final
cdef class Joints:
    cdef readonly Py_ssize_t n_j
