cdef class Machine:
    cdef object numbers, out_array, signs, lengths, kept
    cdef readonly Py_ssize_t n, n_guards
    cdef readonly double dt, shortest
    cdef readonly Functions fields
    cdef Functions surfaces, values, resets
    cdef Indices has_reset, first, at_once, kind, target, below, above
    cdef Doubles sign, length, out, F, F1, F2, H_x, g_x, x, x_guard, moved
