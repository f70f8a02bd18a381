from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t begin_motion(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
