cimport cython
from lcpstep.events.flight.clear cimport WORTH, clear_until, suspect
from lcpstep.events.flight.keep cimport keep, keep_event, keep_times
from lcpstep.events.flight.modes cimport go_on, impact, release, settle, settle_again, turn_corner
from lcpstep.events.flight.motion cimport Flight, free, on_obstacle, rebase
from lcpstep.events.flight.near cimport SHORT, along, hop_end, is_low, low_end, stretch
from lcpstep.events.flight.rest cimport contact_impulse, first_release
from lcpstep.events.flight.roots cimport first_contact, polish
from lcpstep.kernels.clock cimport NUDGE
from lcpstep.kernels.course cimport AHEAD, ARRIVED, DUE, Events
from lcpstep.pointers cimport abs, inf, max, min

cdef Py_ssize_t DONE, NOT_FINITE, SLACK
cdef double CLOSED, JUST_RELEASED, NONE, ON_THE_SURFACE, STRIDE, UNSEEN


cdef class Course(Events):
    cdef Flight s
    cdef Py_ssize_t stage(self, Py_ssize_t goal) noexcept nogil
    cdef Py_ssize_t happen(self) noexcept nogil
    cdef Py_ssize_t move(self) noexcept nogil


cdef bint go_further(Flight s) noexcept nogil
cdef bint finite(double g, double u, double alpha) noexcept nogil
cdef bint begin(Flight s) noexcept nogil
@cython.locals(is_hop=bint)
cdef bint fly(Flight s) noexcept nogil
cdef bint skim(Flight s) noexcept nogil
cdef bint leap(Flight s) noexcept nogil
cdef void pass_end(Flight s, double end) noexcept nogil
cdef bint rest(Flight s) noexcept nogil
