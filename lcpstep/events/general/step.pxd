cimport cython
from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t NO_FORCES, NO_SURFACE, DONE, JOINTS_FAILED, NOT_FINITE, PARTS, MOST_PARTS, REFINEMENTS
cdef Py_ssize_t LOOKS
cdef double FAR, LOOK_AHEAD, BALANCED, FURTHER

@cython.locals(squeezed=bint)
cdef Py_ssize_t step(Mechanism s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t stride(Mechanism s) noexcept nogil
cdef Py_ssize_t look(Mechanism s, double h) noexcept nogil
cdef Py_ssize_t scan(Mechanism s, double h) noexcept nogil
cdef Py_ssize_t complete(Mechanism s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t complete_to_guard(Mechanism s, Record record, Tally tally) noexcept nogil
cdef void make_dense(Mechanism s, double tau) noexcept nogil
cdef double shorten(Mechanism s, double tau) noexcept nogil
cdef double missed(Mechanism s, double tau) noexcept nogil
@cython.locals(solved=bint, found=bint, balanced=bint, owned=bint)
cdef bint look_ahead(Mechanism s, Py_ssize_t c, double tau, double end) noexcept nogil
@cython.locals(some=bint)
cdef bint any_held(Mechanism s, double t) noexcept nogil
@cython.locals(solved=bint)
cdef bint forces_at(Mechanism s, Py_ssize_t before, double ahead, bint owned) noexcept nogil
cdef void take_over(Mechanism s, Record record, Tally tally, double t, double tau) noexcept nogil
cdef Py_ssize_t pass_end(Mechanism s, Record record, Tally tally) noexcept nogil
