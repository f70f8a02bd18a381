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
        if c.z[a] > 0.0 and not is_kept(c, c.z, a, i, m):
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


def is_kept(c: ContactProblem, p: Doubles, a: int, i: int, m: int) -> bool:
    """Whether p leaves row i of contact a at rest, up to the rounding of an edge.

    There mu T stands beside N, and what friction at its limit does beside what it does.
    """
    u, size = motion_of(c, p, i, m)
    _, beside = motion_of(c, p, a, m)
    mu = c.mu[c.ids[a]]
    limit = mu * mu * c.mobility[i * m + i] * p[a]
    return abs(u) <= AT_REST * size or (i != a and mu * abs(u) <= ROUNDING * (beside + limit))


def is_loaded(c: ContactProblem, a: int, n_a: int, n_f: int) -> bool:
    """Whether contact a is pressed, or one that shares its normal is and may leave it any part of the load."""
    if c.impulse[a] > 0.0:
        return True
    m, shares = n_a + n_f, False
    for b in range(n_a):
        shares = shares or (c.impulse[b] > 0.0 and are_one(c, a, b, m))
    return shares and not moves(c, c.impulse, a, m)


def are_one(c: ContactProblem, i: int, k: int, m: int) -> bool:
    """Whether two rows are one direction, of one sign."""
    own, both = c.mobility[i * m + i] * c.mobility[k * m + k], c.mobility[i * m + k] * c.mobility[k * m + i]
    return c.mobility[i * m + k] > 0.0 and own - both <= DEGENERATE * own


def share_evenly(c: ContactProblem, n_a: int, n_f: int) -> None:
    """Of contacts at rest that share a normal, but no tangent, let each have as much load to spare as the other.

    Else the one that has nothing to spare in a step, up to rounding, opens or gives way, and the other in the next.
    """
    m = n_a + n_f
    for f in range(n_f):
        for h in range(f):
            a, b, S, T = c.carrier[h], c.carrier[f], n_a + h, n_a + f
            rough = c.mu[c.ids[a]] > 0.0 and c.mu[c.ids[b]] > 0.0
            if rough and are_one(c, a, b, m) and is_loaded(c, a, n_a, n_f) and is_loaded(c, b, n_a, n_f):
                across = c.mobility[S * m + S] * c.mobility[T * m + T] - c.mobility[S * m + T] ** 2
                crossed = across > DEGENERATE * c.mobility[S * m + S] * c.mobility[T * m + T]
                if crossed and is_kept(c, c.impulse, a, S, m) and is_kept(c, c.impulse, b, T, m):
                    balance(
                        c, a, b, abs(c.impulse[S]) / c.mu[c.ids[a]], abs(c.impulse[T]) / c.mu[c.ids[b]], m
                    )


def balance(c: ContactProblem, a: int, b: int, needed: float, too: float, m: int) -> None:
    """Half of what contacts a and b do not need for their friction to each; b's normal is `scale` times a's."""
    scale = c.mobility[a * m + b] / c.mobility[a * m + a]
    spare = 0.5 * (c.impulse[a] - needed + scale * (c.impulse[b] - too))
    if spare > 0.0:
        c.impulse[a], c.impulse[b] = needed + spare, too + spare / scale


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
