cimport cython

cdef double IMPACT, STICK, ACCUMULATION, RELEASE

@cython.locals(k=Py_ssize_t, j=Py_ssize_t, last=Py_ssize_t, n=Py_ssize_t, n_c=Py_ssize_t, n_events=Py_ssize_t)
cpdef object mark(object t, object time, object contact, object kind, object touched, object between)
@cython.locals(c=Py_ssize_t, n=Py_ssize_t, n_c=Py_ssize_t, n_events=Py_ssize_t)
cpdef object close(object t, object time, object contact, object kind, object rate, object closed)
@cython.locals(low=Py_ssize_t, high=Py_ssize_t)
cdef void between(
    double* t, Py_ssize_t n, Py_ssize_t n_c, Py_ssize_t c, double start, double end, unsigned char* marks
) noexcept nogil
