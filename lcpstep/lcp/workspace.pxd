cdef class Workspace:
    cdef object numbers, lists
    cdef Doubles columns, inverse, factor, scaled_b, row_scale, column_scale, x, dx, slack, dslack, left
    cdef Doubles trial, size, ray_direction, ray_start, best, changes, reciprocal
    cdef Indices basic, tight, z_place, w_place, tied, order, active, chosen, nonbasic, place, row, made
    cdef Py_ssize_t waiting
    cdef readonly double residual, best_residual, smallest, ray_dz_0, ray_z_0
    cdef readonly Py_ssize_t iterations
    cdef public bint thorough
