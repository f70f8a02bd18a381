from libc.math cimport sqrt
from lcpstep.pointers cimport inf


cdef inline double first_zero(double g, double u, double half) noexcept nogil:
    if g <= 0.0:
        if u < 0.0:
            return 0.0
        return -u / half if half < 0.0 else inf
    if u >= 0.0:
        if half >= 0.0:
            return inf
        return 0.5 * (u + sqrt(u * u - 4.0 * half * g)) / -half
    cdef double discriminant = u * u - 4.0 * half * g
    return 2.0 * g / (sqrt(discriminant) - u) if discriminant >= 0.0 else inf


cdef inline double accumulation(double u, double alpha, double r) noexcept nogil:
    return 2.0 * u / (-alpha * (1.0 - r))


cdef inline bint may_reach_zero(double g, double u, double half, double tau) noexcept nogil:
    if half <= 0.0:
        return g <= 0.0 or g + tau * (u + tau * half) <= 0.0
    return g <= 0.0 or g + tau * u <= 0.0
