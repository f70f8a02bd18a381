from lcpstep.events.rows.state cimport Rows
from lcpstep.lcp.workspace cimport Workspace
from lcpstep.pointers cimport Doubles, Indices

cdef Py_ssize_t CONTACTS, MARKS, BEGIN, MOVE, JUMP, SETTLE


cdef class Pressed:
    cdef object own
    cdef readonly Py_ssize_t n
    cdef Doubles gap, speed, curve, multiplier, rate, bias, G, turn_impulse, impulse
    cdef void take_rows(self, Rows s, Py_ssize_t first) noexcept nogil


cdef class Contacts(Pressed):
    cdef object history, marks
    cdef Doubles struck, since, chatter_end, rest, owed, terms, turn_speed, synchronous, before, b, z, noise
    cdef Indices member, closed, was_closed, loaded, parting


cdef class Mechanism(Rows):
    cdef object numbers
    cdef readonly object state
    cdef readonly Contacts contact
    cdef Pressed joint
    cdef Workspace lcp
    cdef readonly Py_ssize_t n_members, culprit, evaluations
    cdef readonly double t_end
    cdef double length
    cdef bint bare
    cdef Py_ssize_t next
    cdef Doubles q0, v0, q, v, a, trial, impulse, W
