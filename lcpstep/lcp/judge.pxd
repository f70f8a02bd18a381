cimport cython

cdef double EPSILON, ROUNDING, LITTLE, LOST

cdef double judge(double* W, double* b, double* z, Py_ssize_t n, double* w, double* s) noexcept nogil
cdef double violation(double z, double relative, double part) noexcept nogil
@cython.locals(some=bint)
cdef double weighed(double worst, double* b, double* s, Py_ssize_t n) noexcept nogil
@cython.locals(felt=bint)
cdef double share(double* W, double* z, Py_ssize_t n, double* s, Py_ssize_t i) noexcept nogil
cdef bint proves_infeasible(double* W, double* b, double* y, Py_ssize_t n) noexcept nogil
cdef double worst_of(double* z, double* relative, double* parts, double* b, double* s, Py_ssize_t n) noexcept nogil
