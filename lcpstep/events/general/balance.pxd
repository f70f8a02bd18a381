cimport cython
from lcpstep.events.general.equations cimport measure, measure_again
from lcpstep.events.general.forces cimport contact_forces
from lcpstep.events.general.held cimport constrain, hold_contacts, note
from lcpstep.events.general.state cimport Mechanism
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, after, min

cdef Py_ssize_t DONE, NOT_FINITE, NO_FORCES
cdef double MOMENT, DOUBTFUL

@cython.locals(opened=bint, doubtful=bint)
cdef Py_ssize_t balanced_forces(Mechanism s, double t) noexcept nogil
cdef bint opens(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(known=bint)
cdef bint change_soon(Mechanism s, double t, double tau) noexcept nogil
