"""Forces, or impulses, that keep contacts with friction at rest, wherever there are any.

    W p + b = 0,    p_N >= 0,    |p_T| <= mu p_N        on normals and tangents of contacts that connect

More feet than a body needs share its load in many ways. Where their coefficients differ some of these let it slide
and others hold it, and the law takes both; what is at rest stays so where it can. With p in the edges of its cones,
which have the coordinates x >= 0, the convex problem

    0 <= x   complementary to   E^T (W E x + b) >= 0,    p = E x

comes to W p + b = 0 exactly where some p does: its solutions differ in x alone. Source: R. W. Cottle, J.-S. Pang,
R. E. Stone, The Linear Complementarity Problem (SIAM 2009), chapter 3.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.coulomb import DEGENERATE, ROUNDING, ContactProblem, motion_of
from lcpstep.kernels.vectors import clear
from lcpstep.lcp.kernel import solve_small
from lcpstep.pointers import Doubles, abs

AT_REST = 1e-12  # of the terms of a velocity, or acceleration: less is rounding
SOLVED = 0


def stay(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """Take forces that keep contacts at rest for those in `impulse`, where all that connect can be kept so, or open.

    False where there are no such contacts. Those with an entry of 1 in c.sum : (n_a,) do not count among them.
    """
    m = n_a + n_f
    spread(c, n_a, n_f)
    if solve_small(c.W, c.b, c.z, m, c.work) != SOLVED:
        return False
    gather(c, n_a, n_f)
    for i in range(m):
        a = contact_of(c, i, n_a)
        if c.z[a] > 0.0 and not is_kept(c, a, i, m):
            c.sum[a] = 1.0
    while infects(c, n_a, n_f):
        pass
    some = False
    for i in range(m):
        a = contact_of(c, i, n_a)
        if c.sum[a] == 0.0:
            c.impulse[i] = c.z[i]
            some = True
    return some


def spread(c: ContactProblem, n_a: int, n_f: int) -> None:
    """The problem in the edges of the cones: those of p_T = mu p_N first, then those of p_T = -mu p_N."""
    m = n_a + n_f
    for i in range(m):
        c.b[i] = c.rate[i]
        for k in range(m):
            c.W[i * m + k] = c.mobility[i * m + k]
    for f in range(n_f):
        a, T = c.carrier[f], n_a + f
        mu = c.mu[c.ids[a]]
        for i in range(m):
            normal, tangent = c.W[i * m + a], mu * c.W[i * m + T]
            c.W[i * m + a], c.W[i * m + T] = normal + tangent, normal - tangent
    for f in range(n_f):
        a, T = c.carrier[f], n_a + f
        mu = c.mu[c.ids[a]]
        for k in range(m):
            normal, tangent = c.W[a * m + k], mu * c.W[T * m + k]
            c.W[a * m + k], c.W[T * m + k] = normal + tangent, normal - tangent
        c.b[a], c.b[T] = c.b[a] + mu * c.b[T], c.b[a] - mu * c.b[T]
    clear(c.z, m)


def gather(c: ContactProblem, n_a: int, n_f: int) -> None:
    """Normals and tangents from the edges."""
    for f in range(n_f):
        a, T = c.carrier[f], n_a + f
        one, two, mu = c.z[a], c.z[T], c.mu[c.ids[a]]
        c.z[a], c.z[T] = one + two, mu * (one - two)


def contact_of(c: ContactProblem, i: int, n_a: int) -> int:
    """Whose normal or tangent unknown i is, as the number of its normal."""
    return i if i < n_a else c.carrier[i - n_a]


def moves(c: ContactProblem, p: Doubles, i: int, m: int) -> bool:
    """Whether the impulses p leave the row of unknown i in motion."""
    u, size = motion_of(c, p, i, m)
    return abs(u) > AT_REST * size


def is_kept(c: ContactProblem, a: int, i: int, m: int) -> bool:
    """Whether z leaves row i of contact a at rest, up to the rounding of an edge: there mu T is a term beside N."""
    u, size = motion_of(c, c.z, i, m)
    _, beside = motion_of(c, c.z, a, m)
    return abs(u) <= AT_REST * size or (i != a and c.mu[c.ids[a]] * abs(u) <= ROUNDING * beside)


def is_loaded(c: ContactProblem, a: int, n_a: int, n_f: int) -> bool:
    """Whether contact a is pressed, or one that shares its normal is and may leave it any part of the load."""
    if c.impulse[a] > 0.0:
        return True
    m, shares = n_a + n_f, False
    for b in range(n_a):
        if c.mobility[a * m + b] > 0.0 and c.impulse[b] > 0.0:
            own = c.mobility[a * m + a] * c.mobility[b * m + b]
            shares = shares or own - c.mobility[a * m + b] * c.mobility[b * m + a] <= DEGENERATE * own
    return shares and not moves(c, c.impulse, a, m)


def infects(c: ContactProblem, n_a: int, n_f: int) -> bool:
    """Mark those that impulses connect with one marked; whether there were any."""
    m, some = n_a + n_f, False
    for i in range(m):
        a = contact_of(c, i, n_a)
        for k in range(m):
            b = contact_of(c, k, n_a)
            if c.sum[a] == 1.0 and c.sum[b] == 0.0 and c.mobility[k * m + i] != 0.0:
                c.sum[b], some = 1.0, True
    return some
