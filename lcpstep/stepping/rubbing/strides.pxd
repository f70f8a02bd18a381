cimport cython
from lcpstep.events.contacts.smooth cimport Smooth
from lcpstep.pointers cimport Doubles

cdef Py_ssize_t ARRIVAL
cdef double ROUNDING


cdef class Strides(Smooth):
    cdef object ends
    cdef Py_ssize_t order, n_steps
    cdef double h, t_start, tolerance, span, size_q, size_v, tau
    cdef bint going, based
    cdef readonly Py_ssize_t astray
    cdef Doubles leaving, arriving, middle, push, begin_value, begin_slope, end_value, end_slope, middle_value
    cdef Doubles begin_bend, end_bend
    cdef Doubles half_value, quarter_value, late_value, refined, stored, stored_rates, stored_forces, arrival, pull
    cdef bint step(self, double t, double h) noexcept nogil
    cdef bint complete(self, double t, double h) noexcept nogil
    cdef double pressed(self, Py_ssize_t i, double x) noexcept nogil
    cdef double goal(self, Py_ssize_t steps) noexcept nogil


cdef bint verlet(Strides s, double t, double h) noexcept nogil
@cython.locals(length=double)
cdef bint classical(Strides s, double t, double h) noexcept nogil
cdef bint stays_on_rows(Strides s, double t) noexcept nogil
@cython.locals(worst=Py_ssize_t)
cdef Py_ssize_t worst_row(Strides s) noexcept nogil
cdef void pull_back(Strides s, double h) noexcept nogil
cdef void push_end_back(Strides s, double* v) noexcept nogil
