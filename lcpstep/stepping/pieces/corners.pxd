from libc.math cimport floor
from lcpstep.kernels.dynamics cimport gap_rates, moves
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.vectors cimport product
from lcpstep.pointers cimport abs, inf, max, min
from lcpstep.stepping.pieces.codes cimport CLOSED, GROUND
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.times cimport within

cdef double JUMP

cdef (double, double) find_corners(Plan plan, double t) noexcept nogil
cdef bint obstacles_move(Model m) noexcept nogil
cdef Py_ssize_t choose_jumping(Model m, Plan plan, Work w, double t) noexcept nogil
