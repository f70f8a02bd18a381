cdef double RETURNS, FOR_EVER, GROWN, FAINT, CERTAIN

cdef bint looks_back(Py_ssize_t turn) noexcept nogil
cdef double proportion(double* pushed, double* before, double* now, double* noise, Py_ssize_t n) noexcept nogil
cdef double left(double before, double now, double ratio) noexcept nogil
