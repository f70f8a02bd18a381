from lcpstep.kernels.model cimport Model

cdef void find_extremes(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* g, double* low, double* high
) noexcept
cdef void find_gaps(Model m, Py_ssize_t count, double* t, double* q, double* v, double* out) noexcept
cdef void find_rates(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* G, double* g_t, bint moved, double* out
) noexcept
cdef void find_power(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* M, double* f, double* kinetic, double* power
) noexcept
cdef void find_energy(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* M, double* out
) noexcept
cdef void find_accelerations(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* work, double* out
) noexcept
cdef void find_responses(
    Model m, Py_ssize_t count, double* t, double* q, double* v, double* rates, double* work, double* G, double* MG
) noexcept
