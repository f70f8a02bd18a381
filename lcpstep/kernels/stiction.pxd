cimport cython
from lcpstep.kernels.coefficients cimport Coefficients
from lcpstep.kernels.coulomb cimport ContactProblem, slip, solve_contacts
from lcpstep.pointers cimport abs

cdef double AT_REST
cdef Py_ssize_t SLIDES, STICKS, GIVES_WAY

@cython.locals(again=bint, turns=bint, pressed=bint)
cdef bint solve_steps(
    ContactProblem c, Coefficients k, Py_ssize_t* sticks, double* sliding, Py_ssize_t n_a, Py_ssize_t n_f
) noexcept nogil
cdef double terms(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f, Py_ssize_t f) noexcept nogil
cdef bint moves(ContactProblem c, Py_ssize_t n_a, Py_ssize_t n_f, Py_ssize_t f) noexcept nogil
