cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double COLLAPSE, FIRST, SHORT_TOGETHER
cdef Py_ssize_t AT_ONCE, AT_ONCE_FAST, AT_ONCE_ELASTIC

cdef void idle(Work w) noexcept nogil
@cython.locals(elastic=bint, hops=bint)
cdef void turn(Model m, Plan plan, Work w, Py_ssize_t c, double u, bint struck) noexcept nogil
@cython.locals(found=bint, opens=bint)
cdef bint coupled(Work w, Py_ssize_t c) noexcept nogil
cdef void stick(Work w, Record record, Py_ssize_t c, double t) noexcept nogil
cdef void release(
    Model m, Plan plan, Work w, Record record, Py_ssize_t c, double t, double after
) noexcept nogil
cdef double release_time(Work w, Py_ssize_t c, double t, double rest, double deficit) noexcept nogil
