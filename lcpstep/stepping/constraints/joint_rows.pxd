cimport cython
from lcpstep.pointers cimport Doubles, Indices

cdef double NEGLIGIBLE, NOTHING, NEARLY, LOST, RESOLUTION, CONTRADICTION, STALLED
cdef Py_ssize_t REFINEMENTS, SWEEPS, VECTORS


cdef class Elimination:
    cdef object numbers, integers
    cdef Py_ssize_t n_j
    cdef bint redundant, swept
    cdef Doubles S, B, F, Z, values, scale, x, y, r, d, P, way, size
    cdef Indices pivots


@cython.locals(regular=bint)
cdef void factorise_joints(Elimination e, double* W, Py_ssize_t stride, Py_ssize_t first) noexcept nogil
cdef bint arrived(
    double worst, double before, double slack, double* G, Py_ssize_t n, double* q, Py_ssize_t n_q
) noexcept nogil
cdef void diagonalise(Elimination e) noexcept nogil
cdef void rotate(double* B, double* V, Py_ssize_t p, Py_ssize_t q, Py_ssize_t n) noexcept nogil
cdef void solve_joints(Elimination e, double* out) noexcept nogil
cdef void apply_inverse(Elimination e) noexcept nogil
cdef void eliminate(
    Elimination e, double* W, Py_ssize_t n, double* H, double* X, Py_ssize_t n_q, Py_ssize_t* ids, Py_ssize_t n_a,
    Py_ssize_t n_k, double* R, double* rate
) noexcept nogil
cdef void sweep_out(
    Elimination e, double* H, double* X, Py_ssize_t n_q, Py_ssize_t* ids, Py_ssize_t n_a, Py_ssize_t n_j, double* R
) noexcept nogil
cdef void leave(
    Elimination e, double* row, double* J, double* share, Py_ssize_t n_q, double* out
) noexcept nogil
cdef bint lost(Elimination e, double* H, Py_ssize_t n_q, Py_ssize_t i, Py_ssize_t k) noexcept nogil
cdef void distribute(
    Elimination e, double* solution, Py_ssize_t* ids, Py_ssize_t n_a, Py_ssize_t n_k, double* p, Py_ssize_t n
) noexcept nogil
@cython.locals(hold=bint)
cdef bint joints_hold(
    double* J, double* J_t, double* J_start, Py_ssize_t n_j, double* v, double* v_free, double* v_next,
    Py_ssize_t n_q, double* X, double* p, Py_ssize_t n, double turning, Py_ssize_t* failed,
) noexcept nogil
