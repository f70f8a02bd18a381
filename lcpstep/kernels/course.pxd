from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t BUFFER_FULL, DONE, TOO_MANY_EVENTS, DUE, AHEAD, ARRIVED


cdef class Course:
    cpdef Py_ssize_t advance(self, Py_ssize_t goal)
    cdef Py_ssize_t go_on(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t refusal(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef class Stepwise(Course):
    cdef double t0
    cdef Py_ssize_t first, last
    cdef Py_ssize_t take(self, double t0, Py_ssize_t first, Py_ssize_t last) noexcept nogil


cdef class Events(Course):
    cdef Record record
    cdef Tally tally
    cdef Py_ssize_t room
    cdef Py_ssize_t refusal(self) noexcept nogil
