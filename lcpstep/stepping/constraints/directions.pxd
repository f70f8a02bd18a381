cimport cython
from lcpstep.kernels.linear cimport solve_definite
from lcpstep.kernels.vectors cimport copy, largest, product
from lcpstep.pointers cimport abs, after, max

cdef double CONVERGED, CANCELLED, ROUNDING, NO_APPROACH, CONTRADICTION

cdef Py_ssize_t take_part(
    Py_ssize_t* ids, Py_ssize_t* carrier, double* mu, Py_ssize_t n_a, Py_ssize_t n_c, Py_ssize_t n_t, Py_ssize_t n_j
) noexcept nogil
cdef void position(
    double h, double theta, double* q, double* v, double* v_next, double* q_next, Py_ssize_t n_q
) noexcept nogil
cdef void average(double* J, double* J_start, double theta, double* D, Py_ssize_t size) noexcept nogil
cdef void mobilities(
    double* H, double* X, Py_ssize_t* ids, Py_ssize_t n_k, double* W, Py_ssize_t n, Py_ssize_t n_q
) noexcept nogil
cdef void rates(
    double* H, double* H_t, double* v, Py_ssize_t* ids, Py_ssize_t n_k, Py_ssize_t rough, double* b, Py_ssize_t n_q
) noexcept nogil
cdef bint usable(double* b, double* W, Py_ssize_t* ids, Py_ssize_t n_k, Py_ssize_t n) noexcept nogil
cdef void restitute(double* u, double* r, Py_ssize_t* ids, Py_ssize_t n_a, double* b) noexcept nogil
cdef bint strikes(
    double* u, double* v, double* H, Py_ssize_t* ids, Py_ssize_t n_a, double* b, Py_ssize_t n_q
) noexcept nogil
cdef bint apply(
    double* v, double* v_free, double* X, double* p, Py_ssize_t* ids, Py_ssize_t n_f, Py_ssize_t n_k, double* v_next,
    Py_ssize_t n_q,
) noexcept nogil
@cython.locals(hold=bint)
cdef bint joints_hold(
    double* J, double* J_t, double* J_start, Py_ssize_t n_j, double* v, double* v_free, double* v_next,
    Py_ssize_t n_q, double* X, double* p, Py_ssize_t n, double turning, Py_ssize_t* failed,
) noexcept nogil
cdef void divide_by_mass(
    bint constant, double* inverse, double* L, double* row, double* out, Py_ssize_t n_q
) noexcept nogil
