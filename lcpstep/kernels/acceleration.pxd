from lcpstep.kernels.model cimport Model

cdef bint free_acceleration(
    Model m, double t, double* q, double* v, double* M, double* y, double* a
) noexcept nogil
cdef bint divide_by_mass(Model m, double t, double* q, double* v, double* M, double* y, double* a) noexcept nogil
cdef bint factor_mass(Model m, double t, double* q, double* v, double* M) noexcept nogil
cdef void response(Model m, double* M, double* y, double* row, double* out) noexcept nogil
cdef void inverse_mass(Model m, double* M, double* y, double* x) noexcept nogil
