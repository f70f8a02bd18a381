cimport cython
from lcpstep.events.contacts.state cimport Rubbing

cdef Py_ssize_t OPEN, SLIDES, DONE, NOT_FINITE
cdef double RELATIVE_STEP

cpdef object modes(Rubbing s)
cpdef Py_ssize_t settle(Rubbing s, double t, object x, object closed)
cpdef bint hold(Rubbing s, double t, object x, object mode, object direction)
cpdef object field(Rubbing s, double t, object x)
@cython.locals(place=Py_ssize_t)
cpdef object slopes(Rubbing s, double t, object x, object scale)
cpdef object guards(Rubbing s, double t, object x)
cpdef object forces(Rubbing s, double t, object x)
cpdef object pulls(Rubbing s)
cpdef object rows(Rubbing s, double t, object x)
