cimport cython
from lcpstep.events.rows.state cimport Rows
from lcpstep.pointers cimport Doubles, Indices

cdef void unload(Rows s, Doubles force, Indices loaded, Py_ssize_t n_c) noexcept nogil
cdef bint shift(Rows s, Doubles force, Indices loaded, Py_ssize_t n_c) noexcept nogil
cdef Py_ssize_t spread(Rows s, Py_ssize_t c, Doubles force) noexcept nogil
@cython.locals(count=Py_ssize_t)
cdef void share_out(Rows s, double* x) noexcept nogil
cdef bint find_idle(Rows s, Py_ssize_t i, double* z) noexcept nogil
cdef void normalise(double* z, Py_ssize_t n) noexcept nogil
