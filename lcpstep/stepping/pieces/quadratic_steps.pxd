cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.loop cimport Steps
from lcpstep.stepping.pieces.piece cimport begin_piece
from lcpstep.stepping.pieces.state cimport Plan, Work


cdef class QuadraticSteps(Steps):
    cdef bint pass_corner(self, double t) noexcept nogil
    cdef void next_forces(self, double t) noexcept nogil
    cdef Py_ssize_t begin_piece(self, double t) noexcept nogil
    cdef Py_ssize_t find(self, double t) noexcept nogil
    cdef void measure_at(self, double at, double tau) noexcept nogil
    cdef Py_ssize_t follow(self, double t) noexcept nogil
    cdef Py_ssize_t strike(self, double t, Py_ssize_t c) noexcept nogil


cdef void measure_at(Model m, Work w, double at, double tau) noexcept nogil
@cython.locals(found=Py_ssize_t, but=Py_ssize_t, searching=bint)
cdef (Py_ssize_t, double) closing(Model m, Plan plan, Work w, double t, double rest) noexcept nogil
@cython.locals(free=bint)
cdef bint take_in_turn(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
cdef Py_ssize_t room(Plan plan, Work w, Record record) noexcept nogil
cdef void next_forces(Model m, Plan plan, Work w, double t) noexcept nogil
