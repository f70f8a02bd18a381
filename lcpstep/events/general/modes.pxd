cimport cython
from lcpstep.events.general.balance cimport balanced_forces
from lcpstep.events.general.chatter cimport close_chatter, hand_on
from lcpstep.events.general.cycle cimport look_back, recurrence, sum_up
from lcpstep.events.general.equations cimport measure_again
from lcpstep.events.general.forces cimport contact_forces
from lcpstep.events.general.held cimport constrain, hold_contacts, note
from lcpstep.events.general.impact cimport speed_noise, strike
from lcpstep.events.general.keep cimport keep_event
from lcpstep.events.general.motion cimport lift, rebase, rounding_of_gap
from lcpstep.events.general.parabolas cimport polish, synchronise
from lcpstep.events.general.state cimport JUMP, Mechanism
from lcpstep.kernels.clock cimport RESOLUTION
from lcpstep.kernels.dynamics cimport order_matters
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.recurrence cimport FOR_EVER, looks_back
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport copy
from lcpstep.pointers cimport abs, max

cdef Py_ssize_t IMPACT, NO_IMPULSES, RELEASE, STICK, BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS, ROUNDS

cdef Py_ssize_t jump(Mechanism s, Record record, Tally tally) noexcept nogil
@cython.locals(since=double)
cdef bint just_opened(Mechanism s, Py_ssize_t c) noexcept nogil
@cython.locals(landed=bint, new=bint)
cdef bint let_go(Mechanism s) noexcept nogil
cdef void rejoin(Mechanism s) noexcept nogil
@cython.locals(hit=bint)
cdef bint approaches(Mechanism s) noexcept nogil
@cython.locals(strikes=bint)
cdef bint has_come(Mechanism s, Py_ssize_t c) noexcept nogil
cdef void tell_impacts(Mechanism s, Record record, Tally tally, double t) noexcept nogil
cdef Py_ssize_t settle(Mechanism s, Record record, Tally tally) noexcept nogil
cdef Py_ssize_t forces(Mechanism s, double t) noexcept nogil
cdef void obey(Mechanism s, Record record, Tally tally) noexcept nogil
@cython.locals(some=bint)
cdef bint tell_modes(Mechanism s, Record record, Tally tally, double t) noexcept nogil
