cdef class Tangent(RungeKutta):
    cdef object squares, vectors
    cdef readonly object derivative
    cdef readonly Machine m
    cdef Py_ssize_t n_x, mode
    cdef Doubles J, F_x, S, R, R_t, H_x, x, start, F_before, F_after, up, down
