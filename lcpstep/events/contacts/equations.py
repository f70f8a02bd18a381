"""Joints, contacts and their tangents at one state, as kernels: gaps, velocities, friction; see `events.rows`."""

from __future__ import annotations

import cython

from lcpstep.events.contacts.codes import LEANS, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.contacts.state import Rubbing
    from lcpstep.events.rows.equations import (
        free_motion,
        least_effect,
        renew_biases,
        renew_rates,
        respond,
        size_of,
    )
    from lcpstep.events.rows.on_joints import can_bear
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.dynamics import gaps
    from lcpstep.kernels.together import gap_rounding
    from lcpstep.kernels.vectors import largest, product
    from lcpstep.pointers import Doubles, abs, after, max


def measure_rows(s: Rubbing, t: float, y: Doubles) -> bool:
    """Rows with their rates and biases, and the Delassus matrix; the mass matrix must be that of `free_motion`.

    False where a coefficient of friction is none.
    """
    renew_rates(s.rows, t, y, after(y, s.n_q))
    renew_biases(s.rows, t, y, after(y, s.n_q))
    respond(s.rows)
    return measure_friction(s, t, y)


def measure_friction(s: Rubbing, t: float, y: Doubles) -> bool:
    """Coefficients of friction at the sliding velocities, which on the way to zero do not change their sign."""
    if not s.coefficients.varies:
        return True
    q, v = y, after(y, s.n_q)
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        s.slip[c] = product(s.R, v, i, s.n_q) + s.rate[i]
        sticks = s.mode[c] == STICKS or s.mode[c] == LEANS
        if sticks or (s.mode[c] == SLIDES and s.direction[c] * s.slip[c] < 0.0):
            s.slip[c] = 0.0
    return s.coefficients.measure(s.clock.inside(t), q, s.slip)


def rubs(s: Rubbing, c: int) -> bool:
    """Whether contact c may have friction: one whose normal the joints hold already bears nothing to rub with."""
    return s.coefficients.rough[c] == 1 and can_bear(s.rows, c)


def measure(s: Rubbing, t: float, y: Doubles) -> bool:
    """Everything at a state: free acceleration, rows, gaps and velocities; False where something is not finite."""
    if not free_motion(s.rows, t, y, after(y, s.n_q), s.a_free):
        return False
    if not measure_rows(s, t, y):
        return False
    measure_gaps(s, t, y)
    measure_velocities(s, after(y, s.n_q))
    total = 0.0
    for i in range(s.n_r):
        total += s.velocity[i] + s.bias[i] + s.gap[i]
    return total - total == 0.0


def measure_gaps(s: Rubbing, t: float, y: Doubles) -> None:
    """Gaps of joints and contacts."""
    q, v = y, after(y, s.n_q)
    if s.n_j > 0:
        gaps(s.rows.joints, t, q, v, s.gap)
    gaps(s.model, t, q, v, after(s.gap, s.n_j))


def measure_velocities(s: Rubbing, v: Doubles) -> None:
    """Velocities R v + rate of all rows; `terms` of contacts and tangents grow to their rounding.

    Nor is more known of a velocity than what the forces make of it in a time that cannot be told: of what has come to
    rest on its obstacles something is left, smaller at each impact, that means nothing.
    """
    moment = s.clock.untold(0.0)
    for i in range(s.n_r):
        s.velocity[i] = product(s.R, v, i, s.n_q) + s.rate[i]
    for i in range(s.n_c + s.n_t):
        k = s.n_j + i
        unknown = moment * size_of(s.rows, k, 0.0, s.a_free)
        s.terms[i] = max(s.terms[i], NOISE * size_of(s.rows, k, s.rate[k], v) + unknown)


def sliding(s: Rubbing, c: int) -> float:
    """The sliding velocity of contact c as last measured; 0 without friction, where there are no tangents."""
    return s.velocity[s.n_j + s.n_c + c] if s.n_t > 0 else 0.0


def of_tangent(s: Rubbing, x: Doubles, c: int) -> float:
    """Of impulses of contacts, then tangents, that of the tangent of contact c; 0 where there are none."""
    return x[s.n_c + c] if s.n_t > 0 else 0.0


def rounding_of_gap(s: Rubbing, c: int) -> float:
    """Rounding of gap c at the base state, as far as its terms are known."""
    return gap_rounding(s.model, after(s.R, s.n_j * s.n_q), s.q, c, abs(s.gap[s.n_j + c]))


def gap_tolerance(s: Rubbing, c: int) -> float:
    """The gap of contact c that goes without moving a coordinate by more than its tolerance."""
    return least_effect(s.rows, s.n_j + c, s.q)


def share_left(s: Rubbing) -> float:
    """Of the tolerance, as much as is left of the motion at the base state, where that is less; of no motion all.

    What is put right by more than the motion, impact for impact, would not let it die away.
    """
    left = largest(s.q, 0.0, s.n_q) + s.scan_length * largest(s.v, 0.0, s.n_q)
    return left / s.atol if 0.0 < left < s.atol else 1.0


def speed_tolerance(s: Rubbing, i: int) -> float:
    """The velocity of row i that goes without changing a velocity by more than its tolerance."""
    return least_effect(s.rows, i, s.v)


def force_noise(s: Rubbing) -> float:
    """Rounding of the forces of contacts."""
    size = largest(s.force, largest(s.multiplier, 0.0, s.n_r), s.n_q)
    for j in range(s.n_q):
        size = max(size, load_terms(s, j))
    return NOISE * size


def load_terms(s: Rubbing, j: int) -> float:
    """Size of the terms of the force on coordinate j, which may cancel; of callbacks nothing finer is known."""
    size, n = 0.0, s.n_q
    if s.model.linear:
        for k in range(n):
            size += abs(s.model.K[j * n + k] * s.q[k]) + abs(s.model.C[j * n + k] * s.v[k])
        if not s.model.force.given:
            size += abs(s.model.constant[j]) + abs(s.model.cosine[j]) + abs(s.model.sine[j])
    return size


def apply(s: Rubbing, i: int, p: float) -> None:
    """Apply the impulse p on row i; it is summed up for the next kept state.

    Of what impulses make of a velocity, and take from it again, rounding is left.
    """
    for j in range(s.n_q):
        s.v[j] += s.MR[i * s.n_q + j] * p
    for k in range(s.n_c + s.n_t):
        s.terms[k] = max(s.terms[k], NOISE * abs(s.W[(s.n_j + k) * s.n_r + i] * p))
    add_impulse(s, i, p)


def add_impulse(s: Rubbing, i: int, p: float) -> None:
    """Count an impulse of row i: contacts are kept first, then tangents and joints."""
    k = i - s.n_j if i >= s.n_j else s.n_c + s.n_t + i
    s.impulse[k] = s.impulse[k] + p
    # Of their own: differences would depend on what has been kept
    s.turn_impulse[k], s.instant[k] = s.turn_impulse[k] + p, s.instant[k] + p
