cimport cython
from libc.math cimport sqrt
from lcpstep.arrays cimport doubles
from lcpstep.kernels.acceleration cimport factor_mass
from lcpstep.kernels.dynamics cimport gap_rates
from lcpstep.kernels.linear cimport solve_definite
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport after

@cython.locals(i=Py_ssize_t, k=Py_ssize_t, c=Py_ssize_t, best=Py_ssize_t)
cdef void find_turned(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* impulse, bint always, double longest,
    Py_ssize_t parts, double* work, double* out
) noexcept
cdef bint pressed(double* impulse, Py_ssize_t i, Py_ssize_t n_c) noexcept nogil
cdef void look(
    Model m, Py_ssize_t k, double* t, double* q, double* v, double* impulse, bint always, double* work, double* out
) noexcept nogil
cdef double form(Model m, double* M, double* y, double* a, double* b) noexcept nogil
