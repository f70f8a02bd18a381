cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t OPEN, SLIDES, STICKS

cdef bint close_small(Rubbing s, Record record, Tally tally, double t) noexcept nogil
@cython.locals(some=bint)
cdef bint stays_so(Rubbing s, double t) noexcept nogil
cdef double later(Rubbing s, Py_ssize_t c, double t, double T) noexcept nogil
@cython.locals(pull=double, most=double)
cdef bint rests(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(passed_on=bint, hops=bint)
cdef bint hops_on(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(passed_on=bint, slip=double, stops=bint)
cdef bint stops_others(Rubbing s, Py_ssize_t c, double T) noexcept nogil
@cython.locals(rough=bint, at_rest=bint)
cdef void close(Rubbing s, Py_ssize_t c) noexcept nogil
cdef bint slides_on(Rubbing s, Py_ssize_t i, double slip) noexcept nogil
cdef bint leaves_cone(Rubbing s, Py_ssize_t c) noexcept nogil
@cython.locals(direction=double, mode=Py_ssize_t)
cdef void take_back(Rubbing s, Py_ssize_t c) noexcept nogil
