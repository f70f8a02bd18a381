cimport cython
from lcpstep.events.parabolas.state cimport Mechanism

cdef bint strike(Mechanism s) noexcept nogil
@cython.locals(touches=bint)
@cython.locals(touches=bint, takes_part=bint)
cdef void gather(Mechanism s) noexcept nogil
@cython.locals(solved=bint)
cdef bint solve_law(Mechanism s, bint rebounds) noexcept nogil
cdef double impulses(Mechanism s) noexcept nogil
cdef void list_impulses(Mechanism s) noexcept nogil
cdef bint separates(Mechanism s) noexcept nogil
cdef void apply(Mechanism s) noexcept nogil
cdef double speed_noise(Mechanism s, Py_ssize_t c) noexcept nogil
