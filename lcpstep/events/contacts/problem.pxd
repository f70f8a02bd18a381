cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN

cdef Py_ssize_t row_of(Rubbing s, Py_ssize_t a, Py_ssize_t n_a) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) list_unknowns(Rubbing s) noexcept nogil
cdef void fill(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(found=bint)
cdef bint solve_forces(Rubbing s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void allow(Rubbing s, Py_ssize_t n_a, double sign) noexcept nogil
@cython.locals(slides=bint)
cdef void leave_independent(Rubbing s, Py_ssize_t n_a) noexcept nogil
