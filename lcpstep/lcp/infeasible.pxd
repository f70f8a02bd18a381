cdef Py_ssize_t RAY, PIVOTS, LARGEST
cdef double SMALLEST_PIVOT
