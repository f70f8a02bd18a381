cdef class Flight(Clock):
    cdef readonly object state
    cdef object space
    cdef readonly Model model
    cdef Bracket bracket
    cdef Turn turn
    cdef Function frame, motion
    cdef readonly bint contact
    cdef readonly double delta, w2, f0, X, Y, Omega, fc, fs, G, offset, r, response
    cdef readonly double scan, rtol, atol, clear, bend, size, speed
    cdef readonly double now, mode, hold, g, u, alpha, g0, u0, alpha0, peak
    cdef bint begun, on_surface
    cdef double z0, dz0, q0, v0, tau, y_tau, w_tau, a_tau, c1, c2, c3
    cdef Doubles q, v, impulse, moving
