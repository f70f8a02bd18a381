cimport cython
from lcpstep.events.parabolas.state cimport Mechanism

cdef Py_ssize_t SOLVED
cdef double CHECKED

@cython.locals(solved=bint)
cdef bint solve_contacts(Mechanism s) noexcept nogil
cdef void contact_matrix(Mechanism s) noexcept nogil
