cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double SETTLED, EXACT, PULLS
cdef Py_ssize_t SOLVED, REFINEMENTS, NONE, FORCES, IMPULSES

cdef bint solve_unrefined(Work w, double* W, Py_ssize_t n) noexcept nogil
cdef bint solve_several(
    Model m, Plan plan, Work w, double* W, double* inverse, bint factored, Py_ssize_t n, Py_ssize_t guess
) noexcept nogil
cdef bint all_pressed(Work w, double* W, Py_ssize_t n) noexcept nogil
cdef Py_ssize_t still_pressed(
    Model m, Plan plan, Work w, double* W, Py_ssize_t n, Py_ssize_t guess
) noexcept nogil
cdef bint closes(
    Model m, Plan plan, Work w, double* W, Py_ssize_t k, Py_ssize_t n_k, Py_ssize_t guess
) noexcept nogil
cdef bint right(Work w, double* inverse, bint factored, Py_ssize_t n) noexcept nogil
cdef void leftover(Work w, double* inverse, bint factored, Py_ssize_t n) noexcept nogil
cdef Py_ssize_t factor_pressed(Work w, double* W, Py_ssize_t n, bint everybody) noexcept nogil
@cython.locals(answered=bint)
cdef bint refine(
    Work w, double* W, double* inverse, bint factored, Py_ssize_t n, Py_ssize_t n_k, bint solved
) noexcept nogil
@cython.locals(i=Py_ssize_t)
cdef void squeeze(Work w, double* W, Py_ssize_t n, Py_ssize_t n_k) noexcept nogil
cdef (double, double) correct(Work w, Py_ssize_t n, Py_ssize_t n_k) noexcept nogil
@cython.locals(pressed=bint)
cdef bint keep_closed(Work w, double* W, double* MG, Py_ssize_t n) noexcept nogil
cdef bint presses(Work w, double* W, Py_ssize_t n) noexcept nogil
