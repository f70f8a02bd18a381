cimport cython
from lcpstep.events.rows.state cimport Rows

cdef double PARTED, DISAGREEMENT

@cython.locals(found=bint)
cdef bint is_held(Rows s, Py_ssize_t i) noexcept nogil
cdef Py_ssize_t contradiction(Rows s, double* a) noexcept nogil
cdef Py_ssize_t parted(Rows s, double* gap, double* q) noexcept nogil
