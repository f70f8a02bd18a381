"""Rows of contacts and joints that are held at zero, as kernels: their multipliers x.

    M a = f + R^T x,      R a + bias = 0,      D = R M^-1 R^T  (Delassus matrix)

Rows that depend on others before them are left out; an answer is refined with the residual of M a = f + R^T x itself,
for D has lost the digits of large mass ratios. Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth
Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.general.equations import measure_gaps
    from lcpstep.events.general.state import Mechanism
    from lcpstep.events.rows.equations import (
        free_motion,
        measure_biases,
        measure_rates,
        respond_to,
        size_of_acceleration,
    )
    from lcpstep.kernels.acceleration import inverse_mass
    from lcpstep.kernels.clock import RESOLUTION
    from lcpstep.kernels.linear import grow_factor, solve_factored
    from lcpstep.kernels.vectors import clear, copy, largest, product
    from lcpstep.pointers import Doubles, abs, after

REFINEMENTS = 6
DRIFT = 1e-9  # of the terms of a gap acceleration: one that the rows held do not keep at zero


def hold(s: Mechanism, i: int) -> None:
    """Add row i to the rows held, unless it depends on them as far as rounding lets tell. Factor by Cholesky."""
    k = s.n_held
    s.row[k] = i
    if grow_factor(s.D, s.n_r, s.L, s.n_r, s.row, s.doubt, k):
        s.n_held = k + 1


def hold_joints(s: Mechanism) -> None:
    """Hold the independent joints, and nothing else."""
    s.n_held = 0
    for i in range(s.n_j):
        hold(s, i)
    s.n_held_joints = s.n_held


def joints_own(s: Mechanism, c: int) -> bool:
    """Whether the row of contact c says what the joints, which must be the rows held, say: it bears nothing."""
    if s.n_j == 0:
        return False
    k = s.n_held
    hold(s, s.n_j + c)
    own = s.n_held == k
    s.n_held = k
    return own


def hold_contacts(s: Mechanism) -> None:
    """Hold the joints and the closed contacts, those that carry a force first."""
    n_j = s.n_j
    hold_joints(s)
    for unloaded in range(2):
        for c in range(s.n_c):
            if s.contact.closed[c] == 1 and s.contact.loaded[c] == 1 - unloaded:
                hold(s, n_j + c)


def hold_again(s: Mechanism, t: float, q: Doubles, v: Doubles) -> bool:
    """Jacobians and factor of the same rows at another state; False where they have become dependent."""
    measure_biases(s, t, q, v)
    measure_rates(s, t, q, v)
    count = s.n_held
    s.n_held = 0
    for m in range(count):
        i = s.row[m]
        respond_to(s, i)
        for k in range(m + 1):
            j = s.row[k]
            s.D[i * s.n_r + j] = s.D[j * s.n_r + i] = product(s.R, after(s.MR, i * s.n_q), j, s.n_q)
        hold(s, i)
        if s.n_held != m + 1:
            s.n_held = count
            return False
    return True


def solve_held(s: Mechanism, k: int, x: Doubles) -> None:
    """X <- (L L^T)^-1 x for the k rows held."""
    solve_factored(s.L, s.n_r, k, x)


def constrain(s: Mechanism, a: Doubles) -> None:
    """The acceleration a = M^-1 (f + R^T x) that keeps the rows held; multipliers into `held`.

    `a` comes as M^-1 f, f lies in `force`.
    """
    k, n = s.n_held, s.n_q
    clear(s.held, k)
    for _ in range(REFINEMENTS):
        for m in range(k):
            i = s.row[m]
            s.change[m] = -s.bias[i] - product(s.R, a, i, s.n_q)
        solve_held(s, k, s.change)
        if largest(s.change, 0.0, k) <= 4.0 * RESOLUTION * largest(s.held, 0.0, k):
            break
        for m in range(k):
            s.held[m] += s.change[m]
        for j in range(n):
            a[j] = 0.0
            for m in range(k):
                a[j] += s.R[s.row[m] * s.n_q + j] * s.held[m]
            a[j] += s.force[j]
        inverse_mass(s.model, s.M, s.work, a)
    # what rounding of large multipliers leaves is taken out of the acceleration, which must stay on the surface
    for m in range(k):
        i = s.row[m]
        s.change[m] = -s.bias[i] - product(s.R, a, i, s.n_q)
    solve_held(s, k, s.change)
    for m in range(k):
        for j in range(n):
            a[j] += s.MR[s.row[m] * s.n_q + j] * s.change[m]


def accelerate(s: Mechanism) -> None:
    """The acceleration with joints and closed contacts held, into `a`; multipliers, and gap accelerations."""
    copy(s.a, s.a_free, s.n_q)
    hold_contacts(s)
    constrain(s, s.a)
    note(s, s.a)


def note(s: Mechanism, a: Doubles) -> None:
    """Multipliers of the rows held, and the gap accelerations of all contacts.

    Closed contacts whose rows depend on those held are kept by these, but where obstacles move apart.
    """
    n_j, n_c = s.n_j, s.n_c
    for i in range(n_j):
        s.joint.multiplier[i] = 0.0
    for c in range(n_c):
        s.contact.multiplier[c] = 0.0
        s.contact.curve[c] = product(s.R, a, n_j + c, s.n_q) + s.contact.bias[c]
    for m in range(s.n_held):
        i = s.row[m]
        if i < n_j:
            s.joint.multiplier[i] = s.held[m]
        else:
            s.contact.multiplier[i - n_j] = s.held[m]
            s.contact.curve[i - n_j] = 0.0
    for c in range(n_c):
        if s.contact.closed[c] == 1 and not drifts(s, a, c):
            s.contact.curve[c] = 0.0


def drifts(s: Mechanism, a: Doubles, c: int) -> bool:
    """Whether a gap acceleration, in `curve`, is no rounding under the acceleration a."""
    alpha = abs(s.contact.curve[c])
    return alpha > 0.0 and alpha > DRIFT * size_of_acceleration(s, s.n_j + c, a)


def right_hand_side(s: Mechanism, t: float, y: Doubles, dy: Doubles) -> bool:
    """dy = (v, v') with the rows held; False where it is not finite or the rows have become dependent."""
    n = s.n_q
    q, v, a, s.parallel = y, after(y, n), after(dy, n), False
    if not free_motion(s, t, q, v, a):
        return False
    if s.n_held > 0:
        s.parallel = not hold_again(s, s.inside(t), q, v)
        if s.parallel:
            return False
        constrain(s, a)
    copy(dy, v, n)
    return True


def project(s: Mechanism, t: float) -> None:
    """Put q, v onto the rows held, against the drift of the integration: gaps and rates zero."""
    k, n_j, n = s.n_held, s.n_j, s.n_q
    q, v = s.q, s.v
    for level in range(3):  # positions twice, velocities once
        x = q if level < 2 else v
        measure_gaps(s, t)
        if not hold_again(s, t, q, v):
            return
        for m in range(k):
            i = s.row[m]
            if level < 2:
                s.change[m] = -(s.joint.gap[i] if i < n_j else s.contact.gap[i - n_j])
            else:
                s.change[m] = -product(s.R, v, i, s.n_q) - s.rate[i]
        solve_held(s, k, s.change)
        for m in range(k):
            for j in range(n):
                x[j] += s.MR[s.row[m] * s.n_q + j] * s.change[m]
