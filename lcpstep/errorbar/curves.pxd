cimport cython


cdef double ROUNDING, EPS

cdef void find_differences(
    Py_ssize_t n, Py_ssize_t count, double* q, double* v, double* e, double* q2, double* v2, double* e2, double* out
) noexcept
cdef double find_floor(
    Py_ssize_t n, Py_ssize_t count, double* q, double* v, double* e, double latest, double* work, double* out
) noexcept
@cython.locals(size=Py_ssize_t)
cdef void find_largest(
    Py_ssize_t n, Py_ssize_t count, Py_ssize_t stride, double* apart, unsigned char* left_out, double* floor,
    double* most, double* out
) noexcept
@cython.locals(size=Py_ssize_t, last=Py_ssize_t)
cdef void cover(Py_ssize_t n, Py_ssize_t count, unsigned char* hidden, double* apart) noexcept
@cython.locals(first=Py_ssize_t)
cdef void integrate(
    Py_ssize_t n, Py_ssize_t size, Py_ssize_t stride, double* t, double* apart, double* out
) noexcept
@cython.locals(last=Py_ssize_t, e=Py_ssize_t)
cdef void even_out(
    Py_ssize_t n, Py_ssize_t size, Py_ssize_t stride, double* t, double* apart, Py_ssize_t n_even, double* even,
    double* work, double* out
) noexcept
cdef void add_floor(Py_ssize_t n, Py_ssize_t size, double* t, double* floor, double* out) noexcept
@cython.locals(n=Py_ssize_t, end=double)
cdef Py_ssize_t merge(Py_ssize_t count, double* windows, double around) noexcept
@cython.locals(k=Py_ssize_t)
cdef void find_within(Py_ssize_t count, double* intervals, Py_ssize_t n, double* t, unsigned char* out) noexcept
@cython.locals(first=Py_ssize_t, last=Py_ssize_t)
cdef void find_looks(
    Py_ssize_t count, double* intervals, Py_ssize_t n, double* t, Py_ssize_t most, unsigned char* out
) noexcept
