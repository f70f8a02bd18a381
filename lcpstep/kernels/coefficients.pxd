cdef class Coefficients:
    cdef object numbers, marks, kept
    cdef readonly bint varies, two, fixed
    cdef Py_ssize_t n_c, wrong
    cdef double slip
    cdef Doubles sliding, sticking, rest
    cdef Indices rough, tried
    cdef Function function
