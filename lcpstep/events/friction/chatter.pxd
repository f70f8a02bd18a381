cimport cython
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t ACCUMULATION, OPEN, SLIDES, STICKS

cdef bint close_small(Rubbing s, Record record, Tally tally, double t) noexcept nogil
@cython.locals(slow=bint)
cdef bint is_over(Rubbing s, Py_ssize_t c, double u, double height) noexcept nogil
@cython.locals(rough=bint)
cdef void close(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint slides_on(Rubbing s, Py_ssize_t i, double slip) noexcept nogil
cdef bint leaves_cone(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(direction=double, mode=Py_ssize_t)
cdef void take_back(Rubbing s, Py_ssize_t c) noexcept nogil
