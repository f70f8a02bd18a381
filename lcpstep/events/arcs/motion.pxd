cdef class Arc(Clock):
    cdef readonly object state
    cdef object space
    cdef readonly double delta, w2, f0, X, Y, Omega, fc, fs, slip, slip_cosine, slip_sine, belt
    cdef readonly double pull, most, normal, mass, direction, z, dz, phi, end, side
    cdef readonly double now, stride, rtol, atol, paid, friction
    cdef readonly bint begun
    cdef double noise, a, line, room, spring, dzeta, P1, Q1, P2, Q2, cos1, sin1, cos2, sin2
    cdef Doubles place, way, q, v, impulse
