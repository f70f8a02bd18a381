cimport cython
from lcpstep.kernels.model cimport Model

cpdef double extent(
    Model m, double t, object q, object v, double step, double piece, object implicit, bint pushed
)
cpdef double places(Model m, object q, object v, double step)
cdef double displacement(Model m, double t, double* q, double* v, double h, double* work) noexcept
cdef double driven(Model m, double t, double* q, double* v, double h, double* implicit, double* work) noexcept
cpdef bint is_stiff(Model m)
