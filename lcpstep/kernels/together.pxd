from lcpstep.kernels.model cimport Model

cdef double TOGETHER, CROSSED, SAME_OUTCOME
cdef Py_ssize_t TURNS

cdef double gap_rounding(Model m, double* G, double* q, Py_ssize_t c, double path) noexcept nogil
cdef double moment_untold(double rounding, double u, double since) noexcept nogil
cdef bint order_matters(
    double W_c, double W_d, double W_cd, double r_c, double r_d, double u_c, double u_d
) noexcept nogil
cdef (double, double) in_turn(
    double W_c, double W_d, double W_cd, double r_c, double r_d, double u_c, double u_d
) noexcept nogil
