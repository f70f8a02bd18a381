from lcpstep.kernels.bracket cimport Bracket
from lcpstep.kernels.turn cimport Turn
from lcpstep.kernels.clock cimport Clock
from lcpstep.kernels.function cimport Function
from lcpstep.kernels.model cimport Model
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.pointers cimport Doubles

cdef double CLOSED, FREE


cdef class Flight(Clock):
    cdef readonly object state
    cdef object space
    cdef readonly Model model
    cdef readonly Record record
    cdef readonly Tally tally
    cdef Bracket bracket
    cdef Turn turn
    cdef Function frame, motion
    cdef readonly bint contact
    cdef readonly double delta, w2, f0, X, Y, Omega, fc, fs, G, offset, r, response
    cdef readonly double scan, rtol, atol, clear, bend, size, rate
    cdef readonly double now, mode, hold, g, u, alpha, g0, u0, alpha0, peak
    cdef bint begun, on_surface
    cdef double z0, dz0, q0, v0, tau, y_tau, w_tau, a_tau, c1, c2, c3
    cdef Doubles q, v, impulse, moving
    cdef void restart(self, double t, double t_end) noexcept nogil

cdef (double, double) steady(Flight s, double t) noexcept nogil
cdef void absolute(Flight s, double tau) noexcept nogil
cdef (double, double, double) moved(Flight s, Function f, double t) noexcept nogil
cdef (double, double, double) free(Flight s, double tau) noexcept nogil
cdef (double, double, double) on_obstacle(Flight s, double t, double u) noexcept nogil
cdef void leave_from(Flight s, double t, double y, double w) noexcept nogil
cdef void rebase(Flight s, double t) noexcept nogil
cdef void state_at(Flight s, double t) noexcept nogil
