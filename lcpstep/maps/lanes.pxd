cdef class Lanes:
    cdef readonly dict arrays
    cdef object space, own
    cdef Py_ssize_t n
    cdef double h, theta, A_f, A_q, A_v, A_g, W
    cdef Doubles q, v, g, u, p, before, slack, nobody, force, closed, free
cdef void find_free "lcpstep_find_free"(
    double* free, double* q, double* v, double push, double A_q, double A_v, Py_ssize_t n
) noexcept nogil
cdef void find_impulses "lcpstep_find_impulses"(
    double* p, double* free, double* g, double* u, double* slack, double G, double ds, double r, double W, double half, Py_ssize_t n
) noexcept nogil
cdef void move "lcpstep_move"(
    double* q, double* v, double* free, double* p, double A_g, double h, double theta, Py_ssize_t n
) noexcept nogil
cdef void measure "lcpstep_measure"(
    double* g, double* u, double* q, double* v, double G, double height, double ds, Py_ssize_t n
) noexcept nogil
cdef void count_closed "lcpstep_count_closed"(double* closed, double* p, Py_ssize_t n) noexcept nogil
