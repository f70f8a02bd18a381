cimport cython
from lcpstep.kernels.model cimport Model

@cython.locals(i=Py_ssize_t, k=Py_ssize_t, best=Py_ssize_t)
cpdef steepest(Model m, object t, object q, object v, object impulse, double longest, Py_ssize_t parts)
@cython.locals(i=Py_ssize_t, j=Py_ssize_t, c=Py_ssize_t)
cdef void weigh(
    Model m, Py_ssize_t k, double* t, double* q, double* v, double* impulse, double* work, double* out
) noexcept nogil
cdef double form(double* A, double* x, Py_ssize_t n) noexcept nogil
