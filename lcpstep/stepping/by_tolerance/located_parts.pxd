from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan

cdef class Led:
    cdef object kept
    cdef Py_ssize_t code
    cdef double time, off
    cdef Doubles q, v, gap, half, force, impulse
    cdef Indices status

cdef class Parts(Control):
    cdef Steps way
    cdef Model m
    cdef Plan plan
    cdef Work w, saved
    cdef object own_row
    cdef Py_ssize_t n_numbers, n_marks, n_matrices
    cdef Doubles last_row, A_inverse, AG, WA
    cdef bint rough, means, alike, sized
    cdef Led one, half, two
    cdef double elapsed, stuck
