cimport cython
from lcpstep.kernels.model cimport Model

cdef double longest_way(
    Model m, double t, double* q, double* v, double step, double piece, double* inverse, bint pushed, double* work
) noexcept
cdef double of_places(Model m, double* q, double* v, double step) noexcept
cdef double displacement(Model m, double t, double* q, double* v, double h, double* work) noexcept
cdef double driven(Model m, double t, double* q, double* v, double h, double* implicit, double* work) noexcept
cpdef bint is_stiff(Model m)
