cimport cython
from lcpstep.events.rows.state cimport Rows

cdef double CLOSED, HELPS, TOLERANCES
cdef Py_ssize_t FEW, MOST

cdef bint project(Rows s, double t, double* q, double* v) noexcept nogil
@cython.locals(anew=bint, helps=bint)
cdef bint put_on_rows(Rows s, double t, double* q, double* v) noexcept nogil
cdef void push_onto_rows(Rows s, double* v) noexcept nogil
cdef bint are_open(Rows s, double t, double* q, double* v) noexcept nogil
@cython.locals(none=bint)
cdef bint none_open(Rows s, double* q, double tolerances) noexcept nogil
cdef bint take_rows(Rows s, double t, double* q, double* v) noexcept nogil
