from lcpstep.kernels.model cimport Model

cpdef surplus(Model m, object t, object q, object v, double near)
cdef double kinetic(Model m, double t, double* q, double* v, double* M) noexcept nogil
cdef double power(
    Model m, double t, double* q, double* v, double near, double* work, double* out
) noexcept nogil
