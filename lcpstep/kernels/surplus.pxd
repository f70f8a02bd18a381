from lcpstep.kernels.model cimport Model

cdef void add_up(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double near, double* work, double* out
) noexcept
cdef double kinetic(Model m, double t, double* q, double* v, double* M) noexcept nogil
cdef double power(
    Model m, double t, double* q, double* v, double near, double* work, double* out
) noexcept nogil
