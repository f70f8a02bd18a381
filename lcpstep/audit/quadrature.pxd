cimport cython
from lcpstep.kernels.model cimport Model

@cython.locals(n=Py_ssize_t, width=Py_ssize_t, n_q=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t,
               h=double, start=double)
cpdef object errors(
    Model m, object t, object B, object v, object jumps, object weights, object nodes, double noise, object place,
    object speed, object within
)
@cython.locals(n=Py_ssize_t, i=Py_ssize_t, j=Py_ssize_t, node=Py_ssize_t, size=double, c=double,
               force=double, good=bint)
cdef void lead(
    Model m, double t, double h, double* b, Py_ssize_t width, double* x, double* rule, double noise, double* work,
    double* place, double* speed, double* within
) noexcept nogil
