cimport cython
from lcpstep.arrays cimport doubles
from lcpstep.events.friction.equations cimport free_motion, measure, measure_rows
from lcpstep.events.friction.guards cimport look
from lcpstep.events.friction.held cimport hold_modes, pull, right_hand_side
from lcpstep.events.friction.impact cimport find_free
from lcpstep.events.friction.modes cimport decide, adopt_modes
from lcpstep.events.friction.state cimport GUARDS, Rubbing
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, max

cdef Py_ssize_t OPEN, SLIDES, DONE, NOT_FINITE
cdef double RELATIVE_STEP

cpdef object modes(Rubbing s)
cpdef Py_ssize_t settle(Rubbing s, double t, object x, object closed)
cpdef bint hold(Rubbing s, double t, object x, object mode, object direction)
cpdef object field(Rubbing s, double t, object x)
@cython.locals(place=Py_ssize_t)
cpdef object slopes(Rubbing s, double t, object x)
cpdef object guards(Rubbing s, double t, object x)
cpdef object forces(Rubbing s, double t, object x)
cpdef object pulls(Rubbing s)
cpdef object rows(Rubbing s, double t, object x)
