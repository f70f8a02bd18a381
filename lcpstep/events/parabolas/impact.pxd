cimport cython
from lcpstep.events.parabolas.state cimport Mechanism

cdef Py_ssize_t OPEN, SLIDES

@cython.locals(found=bint)
cdef bint strike(Mechanism s) noexcept nogil
@cython.locals(touches=bint, takes_part=bint)
cdef void gather(Mechanism s) noexcept nogil
@cython.locals(solved=bint)
cdef bint solve_law(Mechanism s, bint rebounds) noexcept nogil
cdef double impulses(Mechanism s) noexcept nogil
cdef bint separates(Mechanism s) noexcept nogil
