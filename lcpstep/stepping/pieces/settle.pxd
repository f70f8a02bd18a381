cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t settle(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
cdef bint meet(Model m, Plan plan, Work w, double t, double span) noexcept nogil
@cython.locals(some=bint, elastic=bint)
cdef bint matters(Model m, Work w, bint lasting) noexcept nogil
@cython.locals(closed=bint, pressed=bint, touches=bint)
cdef void note(
    Model m, Plan plan, Work w, Record record, double start, double end, double span
) noexcept nogil
cdef Py_ssize_t begin_again(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
