cimport cython


cdef double EARLIER, LATER
cdef Py_ssize_t NODES

@cython.locals(n=Py_ssize_t)
cdef Py_ssize_t keep_once(Py_ssize_t count, double* times, double low, double high) noexcept
@cython.locals(place=Py_ssize_t)
cdef void fill(
    double start, double end, Py_ssize_t n, double* some, Py_ssize_t ends, Py_ssize_t halvings, double* out
) noexcept
cdef void put_nodes(Py_ssize_t n, double* t, double* out) noexcept
@cython.locals(count=Py_ssize_t)
cdef Py_ssize_t find_close(Py_ssize_t n, double* t, double least, double* out) noexcept
