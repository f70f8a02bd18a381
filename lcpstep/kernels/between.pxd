cimport cython


cdef void find_rows(
    Py_ssize_t n, double* t, Py_ssize_t count, double* times, Py_ssize_t least, Py_ssize_t most, Py_ssize_t* out
) noexcept
cdef void go_on_lines(
    Py_ssize_t n, double* t, double* q, double* v, Py_ssize_t count, double* times, Py_ssize_t* rows, double* out,
    double* out_t
) noexcept
@cython.locals(at_end=bint)
cdef void go_on_parabolas(
    Py_ssize_t n, Py_ssize_t last, double* t, double* q, double* v, bint bent, unsigned char* jumps, Py_ssize_t count,
    double* times, Py_ssize_t* rows, double* out, double* out_t
) noexcept
@cython.locals(known=bint)
cdef void accelerate(
    Py_ssize_t n, Py_ssize_t last, double* t, double* q, double* v, double* a, Py_ssize_t count, double* times,
    Py_ssize_t* rows, double* out, double* out_t
) noexcept
cdef void move_by_dense_output(
    Py_ssize_t n, Py_ssize_t terms, double* t, double* q, double* v, double* length, double* F, Py_ssize_t count,
    double* times, Py_ssize_t* rows, double* out, double* out_t
) noexcept
