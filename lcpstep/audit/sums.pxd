cimport cython

cdef Py_ssize_t JUMP, RELEASED

@cython.locals(n=Py_ssize_t, n_q=Py_ssize_t, n_cuts=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t,
               a=double, turn=double, last=double, turned=double, smooth=bint, known=bint, was=bint, had=bint, cut=bint)
cpdef object changes(
    object t, object v, object jumps, object cuts, object first, object second, object size
)
@cython.locals(k=Py_ssize_t, j=Py_ssize_t, before=double, own=double, after=double)
cdef void beside(double* x, Py_ssize_t n, Py_ssize_t n_q, double share, unsigned char* jump) noexcept nogil
@cython.locals(n=Py_ssize_t, n_q=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, off=double, fast=double, moved=double)
cpdef object add_up(object t, object jumps, object place, object speed, object rate, object gone)
@cython.locals(n=Py_ssize_t, n_q=Py_ssize_t, i=Py_ssize_t, k=Py_ssize_t, j=Py_ssize_t, x=double, h=double, end=double)
cpdef object missed(object t, object q, object v, object jumps, object out)
