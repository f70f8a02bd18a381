cimport cython
from lcpstep.kernels.model cimport Model

cdef double DIFFERENCE, REACH, BENT, SMOOTH, LOST
cdef Py_ssize_t SHORTENINGS

cdef void external_force(Model m, double t, double* q, double* v, double* out) noexcept nogil
cdef void total_force(Model m, double t, double* q, double* v, double* out) noexcept nogil
cdef void force_of_mode(Model m, double t, double* q, double* v, double* out) noexcept nogil
cdef void mass(Model m, double t, double* q, double* v, double* out) noexcept nogil
cdef void gaps(Model m, double t, double* q, double* v, double* g) noexcept nogil
cdef void gap_rates(Model m, double t, double* q, double* v, double* G, double* g_t) noexcept nogil
cdef void bias(
    Model m, double t, double low, double high, double* q, double* v, double* shifted, double* G, double* rate,
    double* out
) noexcept nogil
@cython.locals(helped=bint)
cdef double difference_step(
    Model m, double t, double low, double high, double* q, double* v, double* shifted, double* G, double* rate
) noexcept nogil
cdef double middle(double t, double low, double high, double d) noexcept nogil
cdef double differences(
    Model m, double t, double beside, double* q, double* v, double* shifted, double* G, double* rate, double d
) noexcept nogil
cdef void slope_beside(
    Model m, double t, double beside, double* q, double* v, double* shifted, double* G, double* rate, double d,
    double* out
) noexcept nogil
cdef double slope_share(Py_ssize_t k, double x) noexcept nogil
cdef void rates_ahead(
    Model m, double t, double shift, double* q, double* v, double* shifted, double* G, double* rate
) noexcept nogil
cdef void obstacle(Model m, double t, double* q, double* v) noexcept nogil
cpdef bint varies(Model m) noexcept nogil
cpdef bint moves(Model m) noexcept nogil
cdef void carry_obstacles(Model m, double t, double* q, double* v) noexcept nogil
