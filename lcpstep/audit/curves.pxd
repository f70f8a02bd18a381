cimport cython
from lcpstep.audit.clear cimport Gap
from lcpstep.pointers cimport Doubles

cdef double ROUNDING, SECOND


@cython.final
cdef class Curve(Gap):
    cdef readonly Py_ssize_t degree
    cdef object space
    cdef Doubles x, second, part

cdef double casteljau(double* x, Py_ssize_t degree, double share, double* part) noexcept nogil
cdef void differences(Curve g, double size) noexcept nogil
@cython.locals(whole=bint, good=bint, drifts=bint, i=Py_ssize_t, n=Py_ssize_t, n_c=Py_ssize_t, n_q=Py_ssize_t,
               n_cuts=Py_ssize_t, rows=Py_ssize_t, r=Py_ssize_t, c=Py_ssize_t, k=Py_ssize_t, degree=Py_ssize_t, step=Py_ssize_t)
cpdef object clear_curves(
    Curve g, object t, object B, object G, object offset, object obstacle, object absolute, double relative,
    object drift, object touched, object skipped, object cuts, object found
)
cdef double later(
    double* t, unsigned char* touched, Py_ssize_t k, Py_ssize_t n, Py_ssize_t n_c, Py_ssize_t c, double found
) noexcept nogil
cdef object used(object G)
cdef double along(
    Curve g, double* B, double* G, Py_ssize_t* used, Py_ssize_t n_used, Py_ssize_t n_q, double offset
) noexcept nogil
cdef bint at_once(Curve g, Py_ssize_t c, double t, double size, double s, double s_b, bint whole) noexcept nogil
@cython.locals(n=Py_ssize_t, n_q=Py_ssize_t, k=Py_ssize_t, x=double)
cpdef object interpolate(object t, object q, object v, object inner, object begin, object inverse, object B)
@cython.locals(n=Py_ssize_t, n_q=Py_ssize_t, width=Py_ssize_t, k=Py_ssize_t)
cpdef object hulls(object B, Py_ssize_t group, object lo, object hi)
