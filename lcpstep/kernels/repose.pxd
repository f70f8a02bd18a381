cimport cython
from lcpstep.kernels.coulomb cimport ContactProblem

cdef double AT_REST
cdef Py_ssize_t SOLVED

@cython.locals(some=bint)
cdef bint stay(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void spread(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void gather(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef Py_ssize_t contact_of(ContactProblem c, Py_ssize_t i, Py_ssize_t n_a) noexcept nogil
cdef bint moves(ContactProblem c, double* p, Py_ssize_t i, Py_ssize_t m) noexcept nogil
@cython.locals(some=bint)
cdef bint infects(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
