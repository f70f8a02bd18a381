from lcpstep.events.hybrid.state cimport Motion
from lcpstep.events.rows.state cimport Rows
from lcpstep.kernels.bracket cimport Bracket
from lcpstep.kernels.rungekutta cimport RungeKutta
from lcpstep.kernels.turn cimport Turn
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t CONTACTS, MARKS, BEGIN, MOVE, JUMP, SETTLE, OBEY, SWITCH, LOOKED, ENTERED, JUMPED


cdef class Seen:
    cdef object seen
    cdef readonly Py_ssize_t n
    cdef Doubles gap, speed, curve, multiplier


cdef class Pressed(Seen):
    cdef object own
    cdef Doubles rate, bias, G, turn_impulse, impulse
    cdef void take_rows(self, Rows s, Py_ssize_t first) noexcept nogil


cdef class Contacts(Pressed):
    cdef object history, marks
    cdef Doubles struck, since, held_until, chatter_end, rest, owed, terms, turn_speed, synchronous, lands, b
    cdef Doubles thrown
    cdef Doubles z, noise
    cdef Indices member, closed, was_closed, loaded, carried, parting


cdef class Mechanism(Rows):
    cdef object rule, numbers, lists
    cdef readonly RungeKutta smooth
    cdef readonly Motion watch
    cdef readonly bint watched
    cdef readonly Contacts contact
    cdef Pressed joint
    cdef Seen start, before, left, right
    cdef Workspace lcp
    cdef Bracket bracket
    cdef Turn turn
    cdef readonly bint constant
    cdef readonly Py_ssize_t n_members, culprit
    cdef readonly double scan, t_end
    cdef double length, found, seen_to, slope
    cdef bint bare, parallel, relieved
    cdef readonly Py_ssize_t event_contact
    cdef Py_ssize_t guards, next, event_kind, n_nodes
    cdef Doubles nodes, weights, q0, v0, q, v, dy, a, trial, impulse, W, turned
    cdef Indices kept
