cimport cython
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.stepping.pieces.state cimport Plan, Work

cdef double NEARLY, DIFFERENCED, UNTOLD, ASTRAY

cdef void stay_at_base(Work w, double t) noexcept nogil
cdef void meet_both(Model m, Work w, double t, double slack) noexcept nogil
cdef void turn_with_joints(Work w, double t) noexcept nogil
cdef void turn_accelerations(Work w, double t) noexcept nogil
@cython.locals(held=bint)
cdef double rate_left(Plan plan, Work w, Py_ssize_t c) noexcept nogil
@cython.locals(some=bint)
cdef bint nearly_held(Work w) noexcept nogil
cdef double left_of(Work w, Py_ssize_t c) noexcept nogil
cdef void load_joints(Work w) noexcept nogil
cdef void reach_joints(Work w, double t, double tau, double slack) noexcept nogil
cdef void meet_joints(Work w, double tau) noexcept nogil
cdef void answer_contact(Work w, Py_ssize_t c, double p, double* impulses) noexcept nogil
cdef void share_out(Work w, Record record, Py_ssize_t first, double now, double tau) noexcept nogil
