from lcpstep.events.general.held cimport solve_held
from lcpstep.events.general.keep cimport keep, keep_wanted
from lcpstep.events.general.motion cimport press, rebase, state_at
from lcpstep.events.general.state cimport JUMP, Mechanism
from lcpstep.kernels.quadratic cimport first_zero
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.kernels.vectors cimport largest, product
from lcpstep.pointers cimport abs, max, min

cdef double LARGE

cdef void fly(Mechanism s, Record record, Tally tally) noexcept nogil
cdef double hop(double u, double alpha) noexcept nogil
cdef double accumulation(double u, double alpha, double r) noexcept nogil
cdef void synchronise(Mechanism s) noexcept nogil
cdef void polish(Mechanism s) noexcept nogil
