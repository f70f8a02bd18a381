cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef Py_ssize_t POLISHING
cdef double BRIEF

@cython.locals(closed=bint)
cdef bint begin_piece(Model m, Plan plan, Work w, Record record, double t) noexcept nogil
cdef void flat_accelerations(Model m, Plan plan, Work w, double t) noexcept nogil
cdef void pressed(Plan plan, Work w, Py_ssize_t place) noexcept nogil
cdef void fitted(Model m, Plan plan, Work w, double t, double rest) noexcept nogil
@cython.locals(some=bint)
cdef bint needs_bias(Plan plan, Work w) noexcept nogil
cdef bint from_ground(Plan plan, Work w, Py_ssize_t c) noexcept nogil
@cython.locals(found=Py_ssize_t)
cdef (Py_ssize_t, double) first_contact(
    Plan plan, Work w, double rest, double t_end, double past, Py_ssize_t but
) noexcept nogil
@cython.locals(falls=bint, near=bint)
cdef (Py_ssize_t, double) polish(
    Model m, Plan plan, Work w, Py_ssize_t c, double t, double tau, double rest
) noexcept nogil
cdef void look(Model m, Plan plan, Work w, double t, double tau) noexcept nogil
cdef double between(
    Model m, Plan plan, Work w, Py_ssize_t c, double t, double low, double high
) noexcept nogil
@cython.locals(wanted=bint, taken=bint)
cdef Py_ssize_t move(Model m, Plan plan, Work w, Record record, double t, double tau, bint to_end) noexcept nogil
@cython.locals(taken=bint)
cdef bint take_back(Plan plan, Work w, Record record, double t) noexcept nogil
cdef bint penetrates(Plan plan, Work w) noexcept nogil
