cdef class Placing:
    cdef Machine m
    cdef Functions mode_of
    cdef object out_array, called
    cdef bint asked
    cdef Py_ssize_t sliding
    cdef Doubles out

cdef class Follow:
    cdef object kept_arrays, numbers
    cdef readonly Motion s
    cdef Switching course
    cdef readonly Tangent tangent
    cdef Placing placing
    cdef bint under_way, tangents_wanted
    cdef readonly Py_ssize_t runs, run, taken, period
    cdef Py_ssize_t n, mode, drop, periods, n_targets, kept, most
    cdef readonly double t_start, t_end
    cdef Doubles x, rate, g_x, starts, targets, radius, scale, states, tangents, impacts, landings, final
    cdef Indices counts, reached, run_taken, codes
