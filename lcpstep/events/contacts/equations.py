"""Joints, contacts and their tangents at one state, as kernels: gaps, velocities, friction; see `events.rows`."""

from __future__ import annotations

import cython

from lcpstep.events.codes import LEANS, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import measure_velocities, speed_tolerance
from lcpstep.events.rows.equations import (
    free_motion,
    list_gaps,
    measure_biases,
    measure_rates,
    respond,
    size_of,
    velocity_of,
)
from lcpstep.kernels.dynamics import harmonic_terms
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import copy, largest
from lcpstep.pointers import Doubles, abs, after, max, min


def measure_rows(s: Rubbing, t: float, y: Doubles) -> bool:
    """Rows with their rates and biases, the Delassus matrix, and friction: False where a coefficient is no number.

    The mass matrix must be that of `free_motion`.
    """
    measure_rates(s.rows, t, y)
    measure_biases(s.rows, t, y)
    respond(s.rows)
    return measure_friction(s, t, y)


def measure_friction(s: Rubbing, t: float, y: Doubles) -> bool:
    """Coefficients of friction at the sliding velocities; False where one is no number.

    A contact that sticks or leans counts as not sliding, and one whose velocity has passed zero within a step, too.
    """
    if not s.coefficients.varies:
        return True
    q, v = y, after(y, s.n_q)
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        s.slip[c] = velocity_of(s.rows, i, v)
        if s.mode[c] in (STICKS, LEANS) or (s.mode[c] == SLIDES and s.direction[c] * s.slip[c] < 0.0):
            s.slip[c] = 0.0
    return s.coefficients.measure(s.rows.inside(t), q, s.slip)


def renew_friction(s: Rubbing) -> bool:
    """Coefficients at the sliding velocities that the impact before has left; False where one is none."""
    if not s.coefficients.varies:
        return True
    copy(s.slip, after(s.velocity, s.n_j + s.n_c), s.n_c)
    return s.coefficients.measure(s.rows.inside(s.rows.t0), s.q, s.slip)


def measure(s: Rubbing, t: float, y: Doubles) -> bool:
    """Everything at a state: free acceleration, rows, gaps and velocities; False where something is not finite."""
    if not free_motion(s.rows, t, y, s.a_free):
        return False
    if not measure_rows(s, t, y):
        return False
    list_gaps(s.rows, t, y, s.gap)
    measure_velocities(s.rows, after(y, s.n_q))
    total = 0.0
    for i in range(s.n_r):
        total += s.velocity[i] + s.bias[i] + s.gap[i]
    return total - total == 0.0


def share_left(s: Rubbing) -> float:
    """By what factor to lessen the tolerance at the base state: a motion smaller than the tolerance is its measure.

    Else what is put right at each impact, by up to the tolerance, would be more than the motion that is left, and
    keep that from dying away. One where the motion is larger, or zero.
    """
    left = largest(s.q, 0.0, s.n_q) + s.scan_length * largest(s.v, 0.0, s.n_q)
    whole = min(s.atol, s.rtol * s.rows.longest)
    return left / whole if 0.0 < left < whole else 1.0


def force_noise(s: Rubbing) -> float:
    """Rounding of the forces of contacts."""
    size = largest(s.force, largest(s.multiplier, 0.0, s.n_r), s.n_q)
    for j in range(s.n_q):
        size = max(size, load_terms(s, j))
    return NOISE * size


def size_of_loads(s: Rubbing, i: int) -> float:
    """Size of the terms of what the forces of joints and contacts make of row i's acceleration."""
    size = 0.0
    for k in range(s.n_r):
        if s.multiplier[k] != 0.0:
            size += abs(s.multiplier[k]) * size_of(s.rows, i, 0.0, after(s.MR, k * s.n_q))
    return size


def load_terms(s: Rubbing, j: int) -> float:
    """Size of the terms of the force on coordinate j, which may cancel; 0 of callbacks, whose terms are not known."""
    size, n = 0.0, s.n_q
    if s.model.linear:
        for k in range(n):
            size += abs(s.model.K[j * n + k] * s.q[k]) + abs(s.model.C[j * n + k] * s.v[k])
        size += harmonic_terms(s.model, j)
    return size


def let_stick(s: Rubbing) -> bool:
    """Let stick what slides without forces no faster than the tolerance tells; whether there is any.

    In a corner of two rough surfaces, where only what sticks has forces, rounding of a blow is no sliding.
    """
    some = False
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        slides = s.mode[c] != OPEN and s.may_stick[c] == 0
        if slides and abs(s.velocity[i]) <= speed_tolerance(s.rows, i):
            s.may_stick[c], s.problem.mu[c], some = 1, s.mu_s[c], True
    return some


def most_friction(s: Rubbing, c: int) -> float:
    """The most friction that contact c, which sticks, may have, and those that it stands for (`leader`)."""
    if not s.sharing:
        return s.mu_s[c] * s.multiplier[s.n_j + c]
    most = 0.0
    for d in range(s.n_c):
        if s.leader[d] == c:
            most += s.mu_s[d] * s.multiplier[s.n_j + d]
    return most
