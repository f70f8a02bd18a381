from lcpstep.arrays cimport doubles, indices
from lcpstep.events.hybrid.state cimport Motion
from lcpstep.kernels.bracket cimport Bracket
from lcpstep.kernels.clock cimport Clock, RESOLUTION
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.rungekutta cimport RungeKutta
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport after, indices_after, inf

cdef Py_ssize_t ROWS, CONTACTS, MARKS, BEGIN, MOVE, JUMP, SETTLE, OBEY, SWITCH, LOOKED, ENTERED, JUMPED
cdef double NOISE


cdef class Seen:
    cdef object seen
    cdef readonly Py_ssize_t n
    cdef double* gap
    cdef double* speed
    cdef double* curve
    cdef double* multiplier


cdef class Rows(Seen):
    cdef object own
    cdef double* rate
    cdef double* bias
    cdef double* shifted
    cdef double* turn_impulse
    cdef double* impulse
    cdef double* G


cdef class Contacts(Rows):
    cdef object history, marks
    cdef double* struck
    cdef double* since
    cdef double* held_until
    cdef double* chatter_end
    cdef double* rest
    cdef double* owed
    cdef double* terms
    cdef double* turn_speed
    cdef double* synchronous
    cdef double* lands
    cdef double* b
    cdef double* z
    cdef double* noise
    cdef Py_ssize_t* member
    cdef Py_ssize_t* closed
    cdef Py_ssize_t* was_closed
    cdef Py_ssize_t* loaded
    cdef Py_ssize_t* carried
    cdef Py_ssize_t* parting


cdef class Mechanism(Clock):
    cdef object rule, numbers, lists
    cdef readonly Model model, joints
    cdef readonly RungeKutta smooth
    cdef readonly Motion watch
    cdef readonly bint watched
    cdef readonly Contacts contact
    cdef Rows joint
    cdef Seen start, left, right
    cdef Workspace lcp
    cdef Bracket bracket
    cdef readonly bint constant
    cdef readonly Py_ssize_t n_q, n_c, n_j, n_r, n_members, culprit
    cdef readonly double scan, t_end, rtol, atol
    cdef double length, found, seen_to, slope
    cdef bint bare
    cdef readonly Py_ssize_t event_contact
    cdef Py_ssize_t guards, next, event_kind, n_nodes, n_held, n_held_joints
    cdef double* nodes
    cdef double* weights
    cdef double* q0
    cdef double* v0
    cdef double* q
    cdef double* v
    cdef double* dy
    cdef double* a
    cdef double* trial
    cdef double* a_free
    cdef double* force
    cdef double* work
    cdef double* M
    cdef double* R
    cdef double* MR
    cdef double* D
    cdef double* L
    cdef double* held
    cdef double* change
    cdef double* doubt
    cdef double* impulse
    cdef double* W
    cdef double* turned
    cdef Py_ssize_t* row
    cdef Py_ssize_t* kept
