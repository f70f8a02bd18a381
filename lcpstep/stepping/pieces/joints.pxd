cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.pointers cimport Doubles
from lcpstep.stepping.constraints.joint_rows cimport Elimination

cdef double HELPS
cdef Py_ssize_t PROJECTIONS, VECTORS


@cython.final
cdef class Joints:
    cdef Model system
    cdef readonly Model rows
    cdef Elimination elimination
    cdef readonly object numbers
    cdef readonly Py_ssize_t n_j, n_q
    cdef public Py_ssize_t failed, culprit
    cdef bint moved
    cdef Doubles turning, stretch, curvature, free, load, piece, answer, push, J, J_try, MJ, S, share, before
    cdef Doubles shifted, P


cdef void take(Joints j, double* M, double t, double* q, double* v) noexcept nogil
cdef void accelerate(
    Joints j, double* M, double t, double low, double high, double* q, double* v, double* a
) noexcept nogil
cdef void bend(Joints j, double t, double low, double high, double* q, double* v) noexcept nogil
cdef void answer(Joints j, double* x, double* rate, double* out) noexcept nogil
cdef void follow(Joints j, double* multipliers, double* x) noexcept nogil
cdef void reduce(Joints j, double* M, Py_ssize_t c, double* row, double* x) noexcept nogil
cdef void put_on_joints(Joints j, double* M, double t, double* q, double* v, double slack) noexcept nogil
cdef void turn_onto_joints(Joints j, double* v) noexcept nogil
