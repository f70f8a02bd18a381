cimport cython
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport Doubles, Indices

cdef double DEGENERATE, ROUNDING, FAST
cdef Py_ssize_t SOLVED


cdef class ContactProblem:
    cdef readonly object arrays
    cdef readonly object lists
    cdef object space
    cdef Doubles mobility, rate, impulse, mu, W, b, z, slow, fast, sum
    cdef Indices ids, carrier
    cdef bint warm
    cdef Workspace work


cdef bint solve_contacts(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef bint solve_normals(ContactProblem c, Py_ssize_t n_a) noexcept nogil
cdef bint solve_frictional(double* R, double* b, double mu, double* p) noexcept nogil
cdef bint solve_three_rows(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef bint solve_four_rows(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(found=bint)
cdef bint solve_slowed(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef (double, double) motion_of(ContactProblem c, double* p, Py_ssize_t i, Py_ssize_t m) noexcept nogil
cdef void begin(ContactProblem c, Py_ssize_t m, Py_ssize_t n) noexcept nogil
