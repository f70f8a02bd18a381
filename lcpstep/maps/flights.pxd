cimport cython
from lcpstep.events.flight.loop cimport Course
from lcpstep.events.flight.motion cimport Flight
from lcpstep.maps.answers cimport Answers

cdef Py_ssize_t BUFFER_FULL, DONE, IMPACT, STICK, INSIDE, UNREACHED, NO_LIMIT, KICKS
cdef double ON_THE_SURFACE, KICK


@cython.final
cdef class Runs:
    cdef Flight s, aside
    cdef Course course
    cdef Answers answers
    cdef readonly Py_ssize_t taken
    cdef Py_ssize_t run, code, period, age, power, kicked, noisy
    cdef bint begun
    cdef double old_q, old_v, length, speed


cpdef bint follow(Runs r, Py_ssize_t until) except? -1
cdef bint follow_all(Runs r, Py_ssize_t until) noexcept nogil
cdef void begin(Runs r, Py_ssize_t i) noexcept nogil
cdef bint admissible(Flight s, double t) noexcept nogil
@cython.locals(tangent=bint)
cdef Py_ssize_t one_period(Runs r, Py_ssize_t i, Py_ssize_t k) noexcept nogil
cdef void note_events(Runs r, Py_ssize_t i, Py_ssize_t k) noexcept nogil
@cython.locals(dropped=bint)
cdef void look_for_cycle(Runs r) noexcept nogil
cdef void answer(Runs r, Py_ssize_t i, Py_ssize_t k) noexcept nogil
