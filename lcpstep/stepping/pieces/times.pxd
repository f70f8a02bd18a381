from lcpstep.pointers cimport abs, max, min
from lcpstep.stepping.pieces.codes cimport EPS, LATE
from lcpstep.stepping.pieces.state cimport Plan, Work


cdef inline double within(Work w, double t) noexcept nogil:
    return min(max(t, w.low + w.margin), w.high - w.margin)


cdef inline bint at_corner(Plan plan, Work w, double t) noexcept nogil:
    return not plan.plain and t >= w.high - 2.0 * w.margin


cdef inline double driven_by(Work w, Py_ssize_t c, double t) noexcept nogil:
    return 4.0 * EPS * abs(t * w.gap_t[c])


cdef inline double rounded_by(Plan plan, Work w, Py_ssize_t c, double t) noexcept nogil:
    return (plan.margin + 4.0 * EPS * abs(t)) * abs(w.bias[c])


cdef inline double just_after(Plan plan, double t) noexcept nogil:
    return t + LATE * plan.h + 4.0 * EPS * abs(t)
