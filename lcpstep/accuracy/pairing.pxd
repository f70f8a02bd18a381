cdef Py_ssize_t NEITHER, PAIR, SKIP

cdef void fill_partners(
    double* a, Py_ssize_t n, double* b, Py_ssize_t m, double within, Py_ssize_t* low, Py_ssize_t* high,
    Py_ssize_t* cells, unsigned char* origin, double* row, double* before, Py_ssize_t* partner
) noexcept nogil
