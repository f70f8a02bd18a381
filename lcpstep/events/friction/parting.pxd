cimport cython
from lcpstep.events.friction.equations cimport measure
from lcpstep.events.friction.held cimport constrain, hold_modes
from lcpstep.events.friction.modes cimport decide
from lcpstep.events.friction.state cimport Rubbing
from lcpstep.kernels.vectors cimport copy, product
from lcpstep.pointers cimport abs

cdef Py_ssize_t OPEN, SLIDES, DONE

@cython.locals(rises=bint)
cdef void part_before(Rubbing s) noexcept nogil
@cython.locals(landed=bint, new=bint)
cdef bint let_go(Rubbing s, double t) noexcept nogil
cdef void rejoin(Rubbing s) noexcept nogil
