cimport cython
from lcpstep.events.contacts.state cimport Rubbing
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally

cdef Py_ssize_t LEANS, NO_FORCES, OPEN, SLIDES, STICKS
cdef Py_ssize_t DONE, PAINLEVE_INCONSISTENT, PAINLEVE_INDETERMINATE
cdef double EDGE, LEANING

@cython.locals(begins=bint)
cdef Py_ssize_t decide(Rubbing s) noexcept nogil
@cython.locals(some=bint, pressed=bint)
cdef void rest_where_possible(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(some=bint, goes=bint)
cdef bint begin_to_slide(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef Py_ssize_t find_forces(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void read_modes(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef double acceleration(Rubbing s, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(some=bint)
cdef bint undecided(Rubbing s) noexcept nogil
@cython.locals(free=bint)
cdef bint idles(Rubbing s, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef bint is_nothing(Rubbing s, Py_ssize_t a, double alpha, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef bint opens(Rubbing s, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef double size_of_terms(Rubbing s, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef double size_of_coupled(Rubbing s, Py_ssize_t a, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef Py_ssize_t obey(Rubbing s, Record record, Tally tally, double t) noexcept nogil
@cython.locals(stands=bint)
cdef Py_ssize_t adopt_modes(Rubbing s) noexcept nogil
@cython.locals(leaning=Py_ssize_t)
cdef void take_over(Rubbing s) noexcept nogil
cdef void stand_alone(Rubbing s) noexcept nogil
cdef bint is_carried(Rubbing s, Py_ssize_t i) noexcept nogil
cdef double gives(Rubbing s, Py_ssize_t i) noexcept nogil
@cython.locals(stands=bint)
cdef bint stand(Rubbing s) noexcept nogil
