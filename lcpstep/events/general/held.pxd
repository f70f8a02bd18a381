cimport cython
from lcpstep.events.general.state cimport Mechanism

cdef Py_ssize_t REFINEMENTS
cdef double DRIFT

cdef void hold(Mechanism s, Py_ssize_t i) noexcept nogil
cdef void hold_joints(Mechanism s) noexcept nogil
@cython.locals(own=bint)
cdef bint joints_own(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void hold_contacts(Mechanism s) noexcept nogil
cdef bint hold_again(Mechanism s, double t, double* q, double* v) noexcept nogil
cdef void solve_held(Mechanism s, Py_ssize_t k, double* x) noexcept nogil
cdef void constrain(Mechanism s, double* a) noexcept nogil
cdef void accelerate(Mechanism s) noexcept nogil
cdef void note(Mechanism s, double* a) noexcept nogil
cdef bint drifts(Mechanism s, double* a, Py_ssize_t c) noexcept nogil
cdef bint right_hand_side(Mechanism s, double t, double* y, double* dy) noexcept nogil
cdef void project(Mechanism s, double t) noexcept nogil
