cdef void follow(double* J, double* e, double* growth, Py_ssize_t m, Py_ssize_t d) noexcept nogil
