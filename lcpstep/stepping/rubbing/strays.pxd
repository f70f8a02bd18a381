from lcpstep.stepping.rubbing.strides cimport Strides

cdef void find_stray(Strides s, double h) noexcept nogil
cdef double first_beyond(Strides s, double end, double level) noexcept nogil
cdef Py_ssize_t straying_after(Strides s, double tau, double level) noexcept nogil
