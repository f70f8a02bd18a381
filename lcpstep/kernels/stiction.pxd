cimport cython
from lcpstep.kernels.coefficients cimport Coefficients
from lcpstep.kernels.coulomb cimport ContactProblem

cdef Py_ssize_t SLIDES, STICKS, GIVES_WAY, MEETS

cdef bint solve_steps(
    ContactProblem c, Coefficients k, Py_ssize_t* sticks, double* sliding, Py_ssize_t n_a, Py_ssize_t n_f,
    bint impact
) noexcept nogil
@cython.locals(some=bint, turns=bint)
cdef bint come_to_rest(
    ContactProblem c, Coefficients k, double* sliding, Py_ssize_t n_a, Py_ssize_t n_f
) noexcept nogil
@cython.locals(some=bint, pressed=bint)
cdef bint give_way(ContactProblem c, Coefficients k, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(some=bint, was=bint)
cdef void rest_where_possible(
    ContactProblem c, Py_ssize_t* sticks, double* sliding, Py_ssize_t n_a, Py_ssize_t n_f
) noexcept nogil
