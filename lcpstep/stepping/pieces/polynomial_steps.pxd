cimport cython

from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.impulses cimport strike
from lcpstep.stepping.pieces.loop cimport Steps
from lcpstep.stepping.pieces.polynomial cimport Polynomial
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double SLOW


cdef class PolynomialSteps(Steps):
    cdef readonly Polynomial z
    cdef bint opens
    cdef Py_ssize_t begin_piece(self, double t) noexcept nogil
    @cython.locals(landing=Py_ssize_t)
    cdef Py_ssize_t find(self, double t) noexcept nogil
    cdef void measure_at(self, double at, double tau) noexcept nogil
    cdef Py_ssize_t follow(self, double t) noexcept nogil
    cdef Py_ssize_t strike(self, double t, Py_ssize_t c) noexcept nogil


@cython.locals(doubtful=bint)
cdef bint is_off(Plan plan, Work w, Polynomial z) noexcept nogil
cdef void lose_force(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
cdef Py_ssize_t follow(
    Model m, Plan plan, Work w, Polynomial z, Record record, double t, double tau, bint ends
) noexcept nogil
cdef double carried(
    Model m, Plan plan, Work w, Polynomial z, double t, double tau, Py_ssize_t c
) noexcept nogil
cdef void slide(Model m, Work w, double t) noexcept nogil
@cython.locals(again=bint)
cdef Py_ssize_t land(Model m, Plan plan, Work w, Record record, double t, Py_ssize_t c) noexcept nogil
