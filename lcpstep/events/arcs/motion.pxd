cimport cython
from lcpstep.kernels.clock cimport Clock
from lcpstep.kernels.record cimport Record
from lcpstep.kernels.tally cimport Tally
from lcpstep.pointers cimport Doubles




cdef class Arc(Clock):
    cdef readonly object state
    cdef object space
    cdef readonly Record record
    cdef readonly Tally tally
    cdef readonly double delta, w2, f0, X, Y, Omega, fc, fs, slip, slip_cosine, slip_sine, belt
    cdef readonly double pull, most, normal, mass, direction, z, dz, phi, end, side
    cdef readonly double now, stride, rtol, atol, paid, friction
    cdef readonly bint begun
    cdef double noise, a, line, room, spring, zeta, dzeta, P1, Q1, P2, Q2, cos1, sin1, cos2, sin2
    cdef Doubles place, way, q, v, impulse

cdef (double, double) turned(double c, double s, double half) noexcept nogil
cdef void look(Arc s, double z, double dz) noexcept nogil
cdef void rebase(Arc s, double t) noexcept nogil
cdef double belt_slip(Arc s) noexcept nogil
cdef void set_out(Arc s, bint slides) noexcept nogil
cdef (double, double) rise(Arc s, double tau) noexcept nogil
cdef (double, double, double) bends(Arc s) noexcept nogil
cdef double bend_at(Arc s, double tau) noexcept nogil
cdef (double, double) state_at(Arc s, double tau) noexcept nogil
cdef double friction_until(Arc s, double tau) noexcept nogil
cdef void pay(Arc s, double tau) noexcept nogil
