cimport cython
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.stepping.rubbing.strides cimport Strides

cdef Py_ssize_t DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, PROJECTION_FAILED
cdef Py_ssize_t LANDINGS, OPEN, TORN
cdef double LOOK_AHEAD, FURTHER

cdef Py_ssize_t stride(Strides s, Record record, Tally tally) noexcept nogil
@cython.locals(seen=bint)
cdef Py_ssize_t search(Strides s, double t, double h) noexcept nogil
cdef bint turns_at_once(Strides s, Py_ssize_t g) noexcept nogil
cdef Py_ssize_t attempt(Strides s, double t, double h) noexcept nogil
cdef Py_ssize_t failed(Strides s) noexcept nogil
cdef Py_ssize_t pass_by(Strides s, Record record, double tau) noexcept nogil
@cython.locals(waits=bint, changes=bint)
cdef Py_ssize_t look_ahead(Strides s, Py_ssize_t c, double h, double tau) noexcept nogil
cdef void take_over(Strides s, Record record, double t, double tau) noexcept nogil
cdef void put_end_back(Strides s) noexcept nogil
cdef double keep_between(Strides s, Record record, double t, double tau) noexcept nogil
cdef void put_between(Strides s, double t) noexcept nogil
@cython.locals(some=bint)
cdef bint leaves_obstacles(Strides s, double t) noexcept nogil
cdef void press(Strides s, double a, double b) noexcept nogil
cdef void arrive_with(Strides s, double t) noexcept nogil
cdef void end_step(Strides s, Record record, Tally tally) noexcept nogil
