cimport cython
from lcpstep.events.rows.state cimport Rows

cdef bint project(Rows s, double t, double* q, double* v) noexcept nogil
cdef bint are_open(Rows s, double t, double* q, double* v) noexcept nogil
cdef bint take_rows(Rows s, double t, double* q, double* v) noexcept nogil
