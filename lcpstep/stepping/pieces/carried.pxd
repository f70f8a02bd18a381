from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport LEAD, Record, TIME
from lcpstep.pointers cimport after

cdef void put_kept_back(Model m, Record record) noexcept nogil
