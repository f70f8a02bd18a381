cimport cython
from lcpstep.kernels.function cimport Functions
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t ARRIVE, EXIT_BELOW, EXIT_ABOVE, NOT_SLIDING, VECTORS, SURFACE
cdef double DIFFERENCE, INNER, OUTER, TINY


@cython.final
cdef class Machine:
    cdef object numbers, out_array, signs, lengths, kept
    cdef readonly Py_ssize_t n, n_guards
    cdef readonly double dt, shortest
    cdef readonly Functions fields
    cdef Functions surfaces, values, resets
    cdef Indices has_reset, first, at_once, kind, target, below, above
    cdef Doubles sign, length, out, F, F1, F2, H_x, g_x, x, x_guard, moved


cdef double reach(Machine m, Py_ssize_t i, double x_i) noexcept nogil
cdef double scalar(Machine m, Functions f, Py_ssize_t k, double t, double* x) noexcept nogil
cdef void field(Machine m, Py_ssize_t mode, double t, double* x, double* out) noexcept nogil
cdef (double, double) approaches(Machine m, Py_ssize_t mode, double t, double* x) noexcept nogil
cdef double surface_gradient(Machine m, Py_ssize_t mode, double t, double* x) noexcept nogil
cdef double guard(Machine m, Py_ssize_t mode, Py_ssize_t k, double t, double* x) noexcept nogil
cdef double guard_gradient(Machine m, Py_ssize_t mode, Py_ssize_t k, double t, double* x) noexcept nogil
cdef double watched(Machine m, Py_ssize_t mode, Py_ssize_t k, double t, double* x) noexcept nogil
cdef double gradient(
    Machine m, Py_ssize_t mode, Py_ssize_t k, double t, double* x, double* beside, double* slopes
) noexcept nogil
cdef (double, double, double) band_and_rate(
    Machine m, Py_ssize_t mode, Py_ssize_t k, double t, double* x, double rtol, double atol
) noexcept nogil
cdef void project(Machine m, Py_ssize_t mode, double t, double* x) noexcept nogil
