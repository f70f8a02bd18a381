cdef class RungeKutta:
    cdef object tables, numbers
    cdef readonly object state
    cdef readonly Py_ssize_t n, positions
    cdef readonly bint dense
    cdef public double rtol, atol, length, next_step
    cdef public Py_ssize_t evaluations
    cdef Py_ssize_t refused, stage
    cdef double stretch_end
    cdef Indices needed
    cdef Doubles A, C, D, E3, E5, y, y_new, y_stage, first, K, F
