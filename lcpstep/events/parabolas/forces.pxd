cimport cython
from lcpstep.events.parabolas.state cimport Mechanism

cdef Py_ssize_t OPEN, DONE, JOINTS_FAILED
cdef double PASSES, DRIFT

cdef Py_ssize_t contact_forces(Mechanism s) noexcept nogil
cdef bint joints_own(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(solved=bint)
cdef bint solve_members(Mechanism s) noexcept nogil
@cython.locals(kept=bint)
cdef void list_forces(Mechanism s) noexcept nogil
@cython.locals(touches=bint)
cdef bint stands(Mechanism s) noexcept nogil
cdef bint enters(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void open_contacts(Mechanism s) noexcept nogil
cdef double passed_on(Mechanism s, Py_ssize_t c) noexcept nogil
