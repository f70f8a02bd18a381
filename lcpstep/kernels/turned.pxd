cimport cython
from lcpstep.kernels.model cimport Model

@cython.locals(always=bint, i=Py_ssize_t, k=Py_ssize_t, c=Py_ssize_t, best=Py_ssize_t)
cpdef farthest_turn(Model m, object t, object q, object v, object impulse, double longest, Py_ssize_t parts)
cdef bint pressed(double* impulse, Py_ssize_t i, Py_ssize_t n_c) noexcept nogil
cdef void look(
    Model m, Py_ssize_t k, double* t, double* q, double* v, double* impulse, bint always, double* work, double* out
) noexcept nogil
cdef double form(Model m, double* M, double* y, double* a, double* b) noexcept nogil
