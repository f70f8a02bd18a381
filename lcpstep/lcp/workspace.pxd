from lcpstep.arrays cimport doubles, indices
from lcpstep.pointers cimport after, indices_after

cdef Py_ssize_t VECTORS, LISTS


cdef class Workspace:
    cdef object numbers, lists
    cdef double* columns
    cdef double* inverse
    cdef double* factor
    cdef double* scaled_b
    cdef double* row_scale
    cdef double* column_scale
    cdef double* x
    cdef double* dx
    cdef double* slack
    cdef double* dslack
    cdef double* left
    cdef double* trial
    cdef double* size
    cdef double* ray_direction
    cdef double* ray_start
    cdef double* best
    cdef double* changes
    cdef double* reciprocal
    cdef Py_ssize_t* basic
    cdef Py_ssize_t* tight
    cdef Py_ssize_t* z_place
    cdef Py_ssize_t* w_place
    cdef Py_ssize_t* tied
    cdef Py_ssize_t* order
    cdef Py_ssize_t* active
    cdef Py_ssize_t* chosen
    cdef Py_ssize_t* nonbasic
    cdef Py_ssize_t* place
    cdef Py_ssize_t* row
    cdef Py_ssize_t* made
    cdef Py_ssize_t waiting
    cdef readonly double residual, best_residual, smallest, ray_dz_0, ray_z_0
    cdef readonly Py_ssize_t iterations
    cdef public bint thorough
