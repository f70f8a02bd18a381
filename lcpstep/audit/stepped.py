"""Motions between the states of steps that say nothing of it: of order 4, of those with friction, and "exact".

Where a motion is free the polynomial of degree five that has the positions, velocities and accelerations of both ends
lies within h^6 / 46080 of the largest sixth derivative of it (P. J. Davis, Interpolation and Approximation, Dover
1975, section 3.5). Before an impact the velocity at the end is not known, and the degree is four; beside closed
contacts accelerations are not, and it is three. What that misses, `missed` asks the forces; of the linear motion of
"exact" steps it has a bound.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.missed import among
from lcpstep.audit.polynomials import Polynomials, through
from lcpstep.kernels import states
from lcpstep.kernels.model import Model
from lcpstep.model import model
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
INNER = 3  # positions within a step that is known by running it again
FREE = 1.0 / 46080.0  # of the sixth derivative: 1 / 6! of the largest x^3 (1 - x)^3
STRUCK = 0.09  # of the fifth, where the velocity at the end is not known
OFF = 0.2  # of the fourth: by how much the velocity may be off that the acceleration is taken with
THIRD = 1.0 / 3.0  # of what that makes of the acceleration
GROWTH = 3.0  # more than e: by how much a state grows in a step
SHORT = 1.0  # (rate h)^2 of steps that have a bound, at most
ENOUGH = 10.0  # roundings within which a free step must be
ASIDE = 1e-9  # of a step: so far from its ends accelerations are taken where there is a corner
AT_CORNER = 1e-11  # of the time: so far from a corner the speed of a frame is asked for
ROUNDED, LATE = 1e-13, 2e-15  # of its largest speed, and of the time: by how much that may be off


def stepped(run: Trajectory, m: Model, closed: Mask, cuts: Array, rounding: float) -> tuple[Polynomials, Any]:
    """The motion between kept states, and how far it may be from "exact" steps: a number, or (m, n_q).

    closed : (m, n_c)   which contacts are closed in a piece;  cuts : (k,)   corners;  rounding : of the positions
    """
    off: Any = None
    contacts: Any = run.scene.contacts
    resting: Mask = np.any(closed, axis=1)
    struck = among(np.array(run.impacts["time"], dtype=float), run.t[1:])  # pieces that end with an event
    t, q, v = (np.ascontiguousarray(x) for x in (run.t, run.q, run.v))
    exact, absolute = getattr(run.method, "order", None) == "exact", False
    if exact and m.frame.given and run.scene.n_q == 1 and turns_evenly(m, cuts):
        m, q, v, absolute = *in_rest(run, m, t), True
    if not exact:
        off = 0.0
    elif run.scene.n_c == 1 or not resting.any():  # of one contact nothing flies while it rests
        off = bounds(m, t, q, v, struck, ENOUGH * rounding)
    friction = run.scene.n_c > 1 and contacts.friction is not None and resting.any()
    if run.scene.n_j > 0 or off is None or friction:  # what holds bodies there may move, which nobody tells
        return made_again(run), 0.0
    a, a_end = accelerations(m, t, q, v, cuts)
    if not np.all(np.isfinite(a) | resting[:, None]):
        return made_again(run), 0.0
    return Polynomials(t, coefficients(m, t, q, v, a, a_end, resting, struck), absolute=absolute), off


def turns_evenly(m: Model, cuts: Array) -> bool:
    """Whether the speed of the frame does not jump at corners: on which side of one it is told is no matter then."""
    c, still = np.zeros((2, len(cuts), m.n_q, 3)), np.zeros(m.n_q)
    beside = AT_CORNER * np.maximum(1.0, np.abs(cuts))
    for side, times in zip(c, (cuts - beside, cuts + beside), strict=True):
        m.frame.sample(times, still, still, side)
    before, after = (
        c[0, ..., 1] + beside[:, None] * c[0, ..., 2],
        c[1, ..., 1] - beside[:, None] * c[1, ..., 2],
    )
    size = np.max(np.abs(c), axis=(0, 2))
    rounding = ROUNDED * np.max(size[:, 1], initial=0.0) + LATE * np.abs(cuts) * size[:, 2]
    return bool(np.all(np.abs(after - before) <= rounding[:, None]))


def in_rest(run: Trajectory, m: Model, t: Array) -> tuple[Model, Array, Array]:
    """A model and the states in coordinates in which the frame rests."""
    c, still = np.zeros((len(t), m.n_q, 3)), np.zeros(m.n_q)
    m.frame.sample(t, still, still, c)
    rest = model(run.scene)
    rest.carried = True
    return rest, run.q + c[..., 0], run.v + c[..., 1]


def made_again(run: Trajectory) -> Polynomials:
    """The motion through positions within steps, by running them again."""
    shares = np.arange(1, INNER + 1) / (INNER + 1)
    times = run.t[:-1, None] + np.diff(run.t)[:, None] * shares
    q, _ = run.at(times.ravel())
    return through(run.t, run.q, run.v, q.reshape(len(times), INNER, -1))


def accelerations(m: Model, t: Array, q: Array, v: Array, cuts: Array) -> tuple[Array, Array]:
    """Without contacts, at the start and at the end of every piece, on its own side of a corner."""
    a = states.accelerations(m, t, q, v)
    first, last = a[:-1], a[1:]
    h, n = np.diff(t), len(t) - 1
    place = np.searchsorted(t, cuts)
    beside = np.unique(np.concatenate([place - 2, place - 1, place]))
    k = beside[(beside >= 0) & (beside < n)]
    if len(k):
        first, last = first.copy(), last.copy()
        first[k] = states.accelerations(m, t[k] + ASIDE * h[k], q[k], v[k])
        last[k] = states.accelerations(m, t[k + 1] - ASIDE * h[k], q[k + 1], v[k + 1])
    return first, last


def coefficients(
    m: Model, t: Array, q: Array, v: Array, a: Array, a_end: Array, resting: Mask, struck: Mask
) -> Array:
    """Bernstein's coefficients of degree five, (m, 6, n_q)."""
    h = np.diff(t)[:, None]
    B = np.empty((len(h), 6, q.shape[1]))
    B[:, 0], B[:, 5] = q[:-1], q[1:]
    B[:, 1], B[:, 4] = q[:-1] + 0.2 * h * v[:-1], q[1:] - 0.2 * h * v[1:]
    B[:, 2] = q[:-1] + h * (0.4 * v[:-1] + 0.05 * h * a)
    B[:, 3] = q[1:] - h * (0.4 * v[1:] - 0.05 * h * a_end)
    k = np.flatnonzero(struck & ~resting)
    if len(k):
        B[k] = before_impacts(m, t[k + 1], h[k], q[k], v[k], a[k], q[k + 1])
    k = np.flatnonzero(resting)
    if len(k):
        B[k] = at_rest(h[k], q[k], v[k], q[k + 1], v[k + 1], struck[k])
    return B


def before_impacts(m: Model, t_end: Array, h: Array, q: Array, v: Array, a: Array, q_end: Array) -> Array:
    """The same of degree four, by the acceleration at the end with the velocity that degree three has there."""
    cubic = q_end - q - h * (v + 0.5 * h * a)
    speed = v + h * a + 3.0 * cubic / np.where(h > 0.0, h, 1.0)
    end = states.accelerations(m, np.ascontiguousarray(t_end), np.ascontiguousarray(q_end), speed)
    quartic = (h * h * (end - a) - 6.0 * cubic) / 6.0
    return from_powers([q, h * v, 0.5 * h * h * a, cubic - quartic, quartic])


def at_rest(h: Array, q: Array, v: Array, q_end: Array, v_end: Array, struck: Mask) -> Array:
    """The same of degree three, or two where the velocity at the end is not that before it."""
    moved = q_end - q - h * v
    cubic = np.where(struck[:, None], 0.0, h * (v_end - v) - 2.0 * moved)
    return from_powers([q, h * v, moved - cubic, cubic])


def from_powers(c: list[Array]) -> Array:
    """Coefficients of degree five from those of powers of the share, each (m, n_q)."""
    shares = np.array(
        [
            [1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
            [0.0, 0.2, 0.4, 0.6, 0.8, 1.0],
            [0.0, 0.0, 0.1, 0.3, 0.6, 1.0],
            [0.0, 0.0, 0.0, 0.1, 0.4, 1.0],
            [0.0, 0.0, 0.0, 0.0, 0.2, 1.0],
        ]
    )
    return np.einsum("pi,pkj->kij", shares[: len(c)], np.stack(c))


def bounds(m: Model, t: Array, q: Array, v: Array, struck: Mask, enough: float) -> Array | None:
    """How far polynomials may be from the linear motion under harmonic forces, (m, n_q); None: too far.

    With s = t / h, q_ss = h^2 f - h M^-1 C q_s - h^2 M^-1 K q, whose rows are summed: (q, q_s) grows at most by e in
    a step, and derivatives bound one another.
    """
    if (m.frame.given and not m.carried) or not m.linear:
        return None
    n, h = m.n_q, np.diff(t)
    M, K, C = (np.asarray(m.arrays[x], dtype=float).reshape(n, n) for x in ("M", "K", "C"))
    with np.errstate(all="ignore"):
        spring, damper = (np.abs(np.linalg.solve(M, x)).sum(axis=1).max() for x in (K, C))
        parts = [
            np.linalg.solve(M, np.asarray(m.arrays[x], dtype=float)) for x in ("constant", "cosine", "sine")
        ]
    steady, swinging = np.max(np.abs(parts[0])), np.max(np.abs(parts[1]) + np.abs(parts[2]))
    kappa, gamma, turn = spring * h * h, damper * h, abs(m.omega) * h
    if not np.all(kappa + gamma <= SHORT):
        return None
    place, speed = np.max(np.abs(q), axis=1)[:-1], h * np.max(np.abs(v), axis=1)[:-1]
    size = GROWTH * (np.maximum(place, speed) + h * h * (steady + swinging))
    second = (kappa + gamma) * size + h * h * (steady + swinging)
    third = kappa * (speed + second) + gamma * second + h * h * swinging * turn
    fourth = kappa * second + gamma * third + h * h * swinging * turn**2
    fifth = kappa * third + gamma * fourth + h * h * swinging * turn**3
    sixth = kappa * fourth + gamma * fifth + h * h * swinging * turn**4
    free = FREE * sixth
    if not np.all(free <= enough):
        return None
    found = np.where(struck, STRUCK * fifth + THIRD * gamma * OFF * fourth, free)
    return np.repeat(found[:, None], n, axis=1)
