"""Joints, contacts and their tangents at one state, as kernels: rows, velocities, biases, the Delassus matrix.

Source: V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (Springer 2008), chapter 3.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import LEANS, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.friction.state import NOISE, Rubbing
    from lcpstep.kernels.acceleration import divide_by_mass, response
    from lcpstep.kernels.dynamics import bias, gap_rates, gaps, total_force
    from lcpstep.kernels.vectors import copy, largest, product
    from lcpstep.pointers import Doubles, abs, after, max


def free_motion(s: Rubbing, t: float, y: Doubles, a: Doubles) -> bool:
    """A <- M^-1 f, f into `force`; False where M is singular or f is not finite."""
    q, v, side = y, after(y, s.n_q), s.clock.inside(t)
    total_force(s.contacts, side, q, v, s.force)
    copy(a, s.force, s.n_q)
    return divide_by_mass(s.contacts, side, q, v, s.M, s.work, a)


def measure_rows(s: Rubbing, t: float, y: Doubles) -> bool:
    """Rows with their rates and biases, and the Delassus matrix; the mass matrix must be that of `free_motion`.

    False where a coefficient of friction is none.
    """
    measure_rates(s, t, y)
    if not s.measured or s.moving:
        measure_biases(s, t, y)
    if not s.measured:
        respond(s)
        s.measured = s.constant
    return measure_friction(s, t, y)


def measure_rates(s: Rubbing, t: float, y: Doubles) -> None:
    """Rows and their rates."""
    if s.measured and not s.moving:
        return
    n, n_j, k = s.n_q, s.n_j, s.n_j + s.n_c
    q, v, side = y, after(y, n), s.clock.inside(t)
    if n_j > 0:
        gap_rates(s.joints, side, q, v, s.R, s.rate)
    gap_rates(s.contacts, side, q, v, after(s.R, n_j * n), after(s.rate, n_j))
    gap_rates(s.tangents, side, q, v, after(s.R, k * n), after(s.rate, k))


def measure_biases(s: Rubbing, t: float, y: Doubles) -> None:
    """Accelerations of the rows that the state alone makes."""
    n_j, k, low, high = s.n_j, s.n_j + s.n_c, s.clock.low, s.clock.high
    q, v, side = y, after(y, s.n_q), s.clock.inside(t)
    if n_j > 0:
        bias(s.joints, side, low, high, q, v, s.shifted, s.G, s.shifted_rate, s.bias)
    bias(s.contacts, side, low, high, q, v, s.shifted, s.G, s.shifted_rate, after(s.bias, n_j))
    bias(s.tangents, side, low, high, q, v, s.shifted, s.G, s.shifted_rate, after(s.bias, k))


def respond(s: Rubbing) -> None:
    """The Delassus matrix of the rows, and what an impulse on each of them does."""
    n, r = s.n_q, s.n_r
    for i in range(r):
        row = after(s.MR, i * n)
        response(s.contacts, s.M, s.work, after(s.R, i * n), row)
        for j in range(i + 1):
            s.W[i * r + j] = s.W[j * r + i] = product(s.R, row, j, n)


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


def measure(s: Rubbing, t: float, y: Doubles) -> bool:
    """Everything at a state: free acceleration, rows, gaps and velocities; False where something is not finite."""
    if not free_motion(s, t, y, s.a_free):
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
        gaps(s.joints, t, q, v, s.gap)
    gaps(s.contacts, t, q, v, after(s.gap, s.n_j))


def measure_velocities(s: Rubbing, v: Doubles) -> None:
    """Velocities R v + rate of all rows; `terms` of contacts and tangents grow to their rounding."""
    for i in range(s.n_r):
        s.velocity[i] = product(s.R, v, i, s.n_q) + s.rate[i]
    for i in range(2 * s.n_c):
        s.terms[i] = max(s.terms[i], NOISE * size_of(s, s.n_j + i, v))


def size_of(s: Rubbing, i: int, v: Doubles) -> float:
    """Size of the terms of the velocity of row i, their signs left aside."""
    size = abs(s.rate[i])
    for j in range(s.n_q):
        size += abs(s.R[i * s.n_q + j] * v[j])
    return size


def gap_size(s: Rubbing, c: int) -> float:
    """Size of the terms of gap c at the base state, as far as they are known."""
    i, size = s.n_j + c, abs(s.gap[s.n_j + c])
    if s.contacts.flat:
        size += abs(s.contacts.offset[c])
    for j in range(s.n_q):
        size += abs(s.R[i * s.n_q + j] * s.q[j])
    return size


def gap_tolerance(s: Rubbing, c: int) -> float:
    """The gap of contact c that goes without moving a coordinate by more than its tolerance."""
    return least_effect(s, s.n_j + c, s.q)


def speed_tolerance(s: Rubbing, i: int) -> float:
    """The velocity of row i that goes without changing a velocity by more than its tolerance."""
    return least_effect(s, i, s.v)


def least_effect(s: Rubbing, i: int, x: Doubles) -> float:
    """What row i can change of itself without changing an x by more than its tolerance, in whatever unit it has."""
    least = -1.0
    for j in range(s.n_q):
        moved = abs(s.MR[i * s.n_q + j])
        if moved > 0.0:
            here = (s.atol + s.rtol * abs(x[j])) * s.W[i * s.n_r + i] / moved
            least = here if least < 0.0 or here < least else least
    return max(least, 0.0)


def force_noise(s: Rubbing) -> float:
    """Rounding of the forces of contacts."""
    size = largest(s.force, largest(s.multiplier, 0.0, s.n_r), s.n_q)
    for j in range(s.n_q):
        size = max(size, load_terms(s, j))
    return NOISE * size


def load_terms(s: Rubbing, j: int) -> float:
    """Size of the terms of a harmonic load on coordinate j, which may cancel; of callbacks nothing finer is known."""
    if not s.contacts.linear or s.contacts.force.given or s.contacts.omega == 0.0:
        return 0.0
    return abs(s.contacts.constant[j]) + abs(s.contacts.cosine[j]) + abs(s.contacts.sine[j])


def apply(s: Rubbing, i: int, p: float) -> None:
    """Apply the impulse p on row i; it is summed up for the next kept state."""
    for j in range(s.n_q):
        s.v[j] += s.MR[i * s.n_q + j] * p
    add_impulse(s, i, p)


def add_impulse(s: Rubbing, i: int, p: float) -> None:
    """Count an impulse of row i: contacts are kept first, then tangents and joints."""
    k = i - s.n_j if i >= s.n_j else 2 * s.n_c + i
    s.impulse[k] = s.impulse[k] + p
