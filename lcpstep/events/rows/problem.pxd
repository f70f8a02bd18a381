cimport cython
from lcpstep.events.rows.contacts cimport Contacts
from lcpstep.pointers cimport Indices

cdef Py_ssize_t OPEN

cdef Py_ssize_t row_of(Contacts s, Py_ssize_t a, Py_ssize_t n_a) noexcept nogil
cdef (Py_ssize_t, Py_ssize_t) list_unknowns(Contacts s) noexcept nogil
cdef void fill(Contacts s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
@cython.locals(found=bint)
cdef bint solve_forces(Contacts s, Py_ssize_t n_a, Py_ssize_t n_f) noexcept nogil
cdef void allow(Contacts s, Py_ssize_t n_a, double sign) noexcept nogil
@cython.locals(slides=bint)
cdef void leave_independent(Contacts s, Py_ssize_t n_a, Indices loaded) noexcept nogil
