cdef class Variations(RungeKutta):
    cdef object vectors, matrix
    cdef Rubbing s
    cdef Py_ssize_t n_x
    cdef readonly bint steady
    cdef Doubles unit, scale, x, beside, F, F_x
