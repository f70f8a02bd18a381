cimport cython
from lcpstep.kernels.dynamics cimport external_force, moves, obstacle
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.quadratic cimport first_zero, may_reach_zero
from lcpstep.kernels.record cimport Record, TIME
from lcpstep.pointers cimport abs, inf
from lcpstep.stepping.pieces.carried cimport PUT_BACK
from lcpstep.stepping.pieces.codes cimport SAME_TIME
from lcpstep.stepping.pieces.keep cimport keep
from lcpstep.stepping.pieces.state cimport Plan, Work
from lcpstep.stepping.pieces.times cimport within

@cython.locals(contact=bint, moving=bint)
cdef void glide(
    Model m, Plan plan, Work w, Record record, double t0, Py_ssize_t first, Py_ssize_t last
) noexcept nogil
