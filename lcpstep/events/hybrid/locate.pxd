cimport cython
from lcpstep.events.hybrid.state cimport Motion

cdef Py_ssize_t SAMPLES, UNKNOWN, PARTS, REFINEMENTS
cdef double FAR, RESOLVED, JUMP

@cython.locals(fine=bint, known=bint, fits=bint, armed=bint)
cdef (Py_ssize_t, double, double, double) find(Motion s, double h, double share) noexcept nogil
cdef void arm(Motion s, double h, double a, double b) noexcept nogil
cdef void sample(Motion s, Py_ssize_t k, double h, double a, double b) noexcept nogil
cdef (double, bint) first_action(Motion s, Py_ssize_t k) noexcept nogil
cdef double locate(Motion s, Py_ssize_t k, double h, double at, double slope) noexcept nogil
cdef double bisect(Motion s, Py_ssize_t k, double h, double at) noexcept nogil
