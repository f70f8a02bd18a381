from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record

cdef double PUT_BACK

cdef void put_kept_back(Model m, Record record, Py_ssize_t first, Py_ssize_t end) noexcept nogil
cpdef displaced(Model m, double t)
