"""Lengths at hand at the start of a run by steps: what rounding of its gaps is of."""

from __future__ import annotations

from math import sqrt
from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.acceleration import free_acceleration
from lcpstep.kernels.dynamics import harmonic_terms, mass
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import finite, largest, product, size_of_product
from lcpstep.pointers import Doubles, abs, after, inf, max


@cython.ccall
def extent(
    m: Model, t: float, q: Any, v: Any, step: float, piece: float, implicit: Any, pushed: bool
) -> float:
    """The largest of places, offsets, and ways within a step or a piece of it, from the state q, v (n_q,) [m].

    implicit : (n_q, n_q)   (M + h/2 C + h^2/4 K)^-1 of a linear system
    pushed : whether forces are looked at too
    """
    space = np.zeros(6 * m.n_q + m.n_q * m.n_q)
    at, at_rate, inverse, work = doubles(q), doubles(v), doubles(implicit), doubles(space)
    found = places(m, q, v, step)
    if m.flat:
        found = max(found, displacement(m, t, at, at_rate, piece, work))
        if pushed:
            found = max(found, driven(m, t, at, at_rate, piece, inverse, work))
    return found


@cython.ccall
def places(m: Model, q: Any, v: Any, step: float) -> float:
    """The largest of places, offsets and ways within a step that v leads along [m]."""
    return largest(m.offset, ways(m, q, v, step), m.n_c)


@cython.ccall
def ways(m: Model, q: Any, v: Any, step: float) -> float:
    """The largest of places and ways within a step that v leads along [m]."""
    at, at_rate = doubles(q), doubles(v)
    return max(largest(at, 0.0, m.n_q), step * largest(at_rate, 0.0, m.n_q))


@cython.ccall
def own_places(offsets: Any, found: float, target: Any) -> None:
    """Places as each contact has them into the target (n_c,): another one's offset rounds no gap of its.

    Where all of its own are zero, the others' tell of a smaller scale, but of none above 1.
    found : the largest of places and ways within a step
    """
    n, offset, own = len(offsets), doubles(offsets), doubles(target)
    most = largest(offset, found, n)
    if most == 0.0 or most > 1.0:
        most = 1.0
    for c in range(n):
        own[c] = max(found, abs(offset[c]))
        if own[c] == 0.0:
            own[c] = most


@cython.cfunc
def displacement(m: Model, t: float, q: Doubles, v: Doubles, h: float, work: Doubles) -> float:
    """How far obstacles and the frame are from their places at the start, and how far they go in a time h [m]."""
    c, found = work, 0.0
    if m.carried:
        m.frame.fill(t, q, v, c)
        if not finite(c, 3 * m.n_q):
            return 0.0
        for i in range(m.n_q):
            found = max(found, abs(c[3 * i]))
    if m.motion.given:
        m.motion.fill(t, q, v, m.motion_now)
        if not finite(m.motion_now, 3 * m.n_c):
            return 0.0
        for i in range(m.n_c):
            s = after(m.motion_now, 3 * i)
            found = max(found, max(abs(s[0]), max(abs(s[1]) * h, abs(s[2]) * h * h)))
    return found


@cython.cfunc
def driven(m: Model, t: float, q: Doubles, v: Doubles, h: float, implicit: Doubles, work: Doubles) -> float:
    """How far forces push in a time h, as stiff springs let them [m]; harmonic ones at their largest."""
    n = m.n_q
    a, f, y, M = work, after(work, n), after(work, 2 * n), after(work, 3 * n)
    free_acceleration(m, t, q, v, M, y, a)
    if m.linear:
        for i in range(n):
            f[i] = abs(product(m.M, a, i, n)) if m.force.given else harmonic_terms(m, i)
        for i in range(n):
            a[i] = size_of_product(implicit, f, i, n)
    return h * h * largest(a, 0.0, n) if finite(a, n) else 0.0


@cython.ccall
def is_stiff(m: Model) -> bool:
    """Whether C or K is not zero."""
    found, n = False, m.n_q * m.n_q
    for i in range(n):
        found = found or m.C[i] != 0.0 or m.K[i] != 0.0
    return found


@cython.ccall
def sizes(m: Model, t: float, q: Any, v: Any, time: float) -> tuple[float, float, float]:
    """How far, and how fast, a system is that goes on from q, v (n_q,) for a time; and its largest coordinate.

    In the metric of its masses, sqrt(q M q) and sqrt(v M v), which tells of coordinates in different units, and of
    those that are zero, as well. All are infinite where nothing is known of the motion: at rest, without forces or
    under forces by a function, which may begin at zero, or at its rounding.
    """
    n = m.n_q
    space = np.zeros(2 * n + 2 * n * n)
    at, at_rate, work = doubles(q), doubles(v), doubles(space)
    M = after(work, 2 * n)
    mass(m, t, at, at_rate, M)
    fast = in_metric(M, at_rate, n)
    if fast > 0.0 or (m.linear and not (m.force.given or m.frame.given)):
        fast += time * push(m, t, at, at_rate, M, work)
    if fast == 0.0:
        return inf, inf, inf
    longest = largest(at, 0.0, n) + time * (largest(at_rate, 0.0, n) + time * largest(work, 0.0, n))
    return in_metric(M, at, n) + time * fast, fast, longest


@cython.cfunc
def in_metric(M: Doubles, x: Doubles, n: int) -> float:
    """The size sqrt(x M x)."""
    square = 0.0
    for i in range(n):
        square += x[i] * product(M, x, i, n)
    return sqrt(max(square, 0.0))


@cython.cfunc
def push(m: Model, t: float, q: Doubles, v: Doubles, M: Doubles, work: Doubles) -> float:
    """The size sqrt(f M^-1 f) of the forces, roughly, whose terms do not cancel; harmonic ones at their largest.

    Accelerations by the same into `work`; all zero where they are not finite.
    """
    n, square = m.n_q, 0.0
    a, f = work, after(work, n)
    free_acceleration(m, t, q, v, after(M, n * n), f, a)
    for i in range(n):
        f[i] = abs(product(M, a, i, n))
        if m.linear:
            f[i] += size_of_product(m.K, q, i, n) + size_of_product(m.C, v, i, n)
            f[i] += harmonic_terms(m, i)
        square += f[i] * f[i] / M[i * n + i]
    for i in range(n):
        a[i] = f[i] / M[i * n + i] if square < inf else 0.0
    return sqrt(square) if square < inf else 0.0
