cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

@cython.locals(contact=bint, moving=bint)
cdef void glide(
    Model m, Plan plan, Work w, Record record, double t0, Py_ssize_t first, Py_ssize_t last
) noexcept nogil
