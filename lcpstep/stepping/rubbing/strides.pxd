cdef class Strides(Smooth):
    cdef object ends
    cdef Py_ssize_t order, n_steps
    cdef double h, t_start, tolerance, span, size_q, size_v, tau, decided
    cdef bint going, based
    cdef readonly Py_ssize_t astray
    cdef Doubles leaving, arriving, middle, push, begin_value, begin_slope, end_value, end_slope, middle_value
    cdef Doubles begin_bend, end_bend
    cdef Doubles half_value, quarter_value, late_value, refined, stored, stored_rates, stored_forces, arrival, pull
