cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double JUMP

cdef (double, double) find_corners(Plan plan, Work w, double t) noexcept nogil
cdef bint obstacles_move(Model m) noexcept nogil
@cython.locals(some=bint)
cdef void go_beyond(Model m, Work w, double t) noexcept nogil
cdef Py_ssize_t choose_jumping(Model m, Plan plan, Work w, double t) noexcept nogil
