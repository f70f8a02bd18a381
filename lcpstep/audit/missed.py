"""What steps of order four, of those with friction, and of those by a tolerance miss: an estimate.

Forces f along the computed motion p of a step h, which begins at (q, v) and ends at (q_1, v_1), say where it ought to
have led,

    v + h int_0^1 f(p(s)) ds - v_1,      q + h v + h^2 int_0^1 (1 - s) f(p(s)) ds - q_1,

by Gauss' three nodes: Picard's iteration, whose own error has a power of h more than that of the step. In between p
is off by no more than h^2/8 of the largest f - p'' as well. Where a contact or joint is closed, what its force can
give, friction's included, is taken out of f - p''. Source: E. Hairer, S. Norsett, G. Wanner, Solving Ordinary
Differential Equations I (Springer 1993), section I.8.
"""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.drift import begins, finite, frequency
from lcpstep.audit.polynomials import Polynomials, basis
from lcpstep.audit.quadrature import errors
from lcpstep.audit.sums import add_up, changes
from lcpstep.kernels import states
from lcpstep.kernels.gauss import gauss
from lcpstep.kernels.model import Model
from lcpstep.model import models
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
NODES, WEIGHTS = gauss(3)
RULE = np.stack([NODES, WEIGHTS])
SAFETY = 2.0  # times the errors found are told: motions may part a little, and nodes do not see all
ROUNDING = 4e-14  # of the positions: what their second differences over a step, times h^2, may be off by
JUMPS = float(Kind.IMPACT), float(Kind.ACCUMULATION), float(Kind.JAM)


def missed(run: Trajectory, m: Model, motion: Polynomials, closed: Mask, cuts: Array, jump: Mask) -> Array:
    """An estimate of how far the computed positions are off in each piece, (m, n_q).

    closed : (m, n_c)   which contacts are closed in a piece;  cuts : (k,)   corners;  jump : see `jumped`
    """
    t, v, B = (np.ascontiguousarray(x, dtype=float) for x in (run.t, run.v, motion.B))
    h = np.diff(t)
    marks = jump.view(np.uint8)
    place, speed, within, first, second, gone = (np.zeros((len(h), run.scene.n_q)) for _ in range(6))
    errors(m, t, B, v, marks, places(motion.degree), RULE, ROUNDING, place, speed, within)
    held = np.flatnonzero(np.any(closed, axis=1) | (run.scene.n_j > 0))
    if run.scene.n_c == 1 and run.scene.n_j == 0:  # nothing flies there, and what follows begins anew
        place[held] = speed[held] = within[held] = 0.0
    elif len(held):
        place[held], speed[held], within[held] = by_rest(run, m, motion, closed[held], held)
    for x in (place, speed, within):
        x[~np.isfinite(x)] = 0.0
    cut = np.ascontiguousarray(cuts)
    parted = np.flatnonzero(
        np.searchsorted(cut, t[:-1], side="right") < np.searchsorted(cut, t[1:], side="left")
    )
    for x in (place, speed):  # a corner within: its parts are steps of their own, as those beside it
        x[parted] = 0.0
        x[parted] = np.maximum(x[np.maximum(parted - 1, 0)], x[np.minimum(parted + 1, len(x) - 1)])
    size, anew = np.zeros(run.scene.n_q), begins(jump, closed)
    if not m.linear:
        changes(t, v, anew, cut, first, second, size)
    add_up(t, anew, place, speed, frequency(run, m, size, second), gone)
    gone += within
    gone *= SAFETY
    return gone


@functools.cache
def places(degree: int) -> Array:
    """Of every node: what Bernstein's coefficients count in the place, in h times the velocity, in h^2 times p''."""
    rows, own = [], np.eye(degree + 1)
    for k, share in ((0, 1.0), (1, degree), (2, degree * (degree - 1.0))):
        rows.append(basis(NODES, degree - k) @ np.diff(own, k, axis=0) * share)
    return np.ascontiguousarray(np.stack(rows, axis=1))


class Nodes:
    """The motion at three places of every piece: t (3 m,), q, v (3 m, n_q), a (m, 3, n_q)."""

    def __init__(self, motion: Polynomials, k: Any) -> None:
        h, B, n = np.diff(motion.t)[k], motion.B[k], motion.B.shape[2]
        with np.errstate(all="ignore"):
            q, v, a = (
                finite(np.matmul(x, B) / h[:, None, None] ** i)
                for i, x in enumerate(places(motion.degree).transpose(1, 0, 2))
            )
        self.t = np.ascontiguousarray((motion.t[k, None] + h[:, None] * NODES).ravel())
        self.q, self.v = (np.ascontiguousarray(x.reshape(-1, n)) for x in (q, v))
        self.a = a


def by_rest(
    run: Trajectory, m: Model, motion: Polynomials, closed: Mask, k: Any
) -> tuple[Array, Array, Array]:
    """The same of pieces with closed contacts or joints, from f - p'': less exact where steps are short."""
    nodes, h = Nodes(motion, k), np.diff(motion.t)[k][:, None]
    off = states.accelerations(m, nodes.t, nodes.q, nodes.v).reshape(nodes.a.shape) - nodes.a
    off, apart = free_part(run, m, closed, off, nodes)
    with np.errstate(all="ignore"):
        noise = ROUNDING * np.max(np.abs(motion.B[k]), axis=1) / (h * h)
    off = np.sign(off) * np.maximum(np.abs(off) - noise[:, None], 0.0)
    moved, turned = np.tensordot(off, WEIGHTS * (1.0 - NODES), (1, 0)), np.tensordot(off, WEIGHTS, (1, 0))
    return np.abs(h * h * moved), np.abs(h * turned), 0.125 * h * h * np.max(np.abs(off), axis=1) + apart


def free_part(run: Trajectory, m: Model, closed: Mask, off: Array, nodes: Nodes) -> tuple[Array, Array]:
    """What of an acceleration (m, 3, n_q) no force of the closed contacts and joints can give.

    And how far positions are from those at which the closed contacts touch, (m, n_q).
    """
    contacts, joints, tangents = models(run.scene)
    t, q, v = nodes.t, nodes.q, nodes.v
    shut = np.repeat(closed, len(NODES), axis=0)
    parts = [(contacts, shut), (tangents, shut), (joints, np.ones((len(t), joints.n_c), dtype=bool))]
    found = [(*states.responses(x, t, q, v), mask) for x, mask in parts if x.n_c > 0]
    G, MG = (np.concatenate([np.where(x[2][..., None], x[i], 0.0) for x in found], axis=1) for i in (0, 1))
    flat = off.reshape(len(t), -1, 1)
    with np.errstate(all="ignore"):
        inverse, back = np.linalg.pinv(np.matmul(G, MG.transpose(0, 2, 1))), MG.transpose(0, 2, 1)
        force = np.matmul(inverse, np.matmul(G, flat))
        gap = np.zeros((len(t), G.shape[1], 1))
        gap[:, : contacts.n_c, 0] = np.where(shut, states.gaps_at(m, t, q), 0.0)
        apart = np.abs(np.matmul(back, np.matmul(inverse, gap))).reshape(off.shape).max(axis=1)
    return np.asarray((flat - np.matmul(back, force)).reshape(off.shape)), apart


def jumped(run: Trajectory, t: Array) -> Mask:
    """At which states velocities may have jumped, (m + 1,)."""
    kinds = np.array(run.impacts["kind"], dtype=float)
    times: Any = np.array(run.impacts["time"], dtype=float)[
        functools.reduce(np.logical_or, (kinds == x for x in JUMPS))
    ]
    return among(times, t)


def among(times: Array, t: Array) -> Mask:
    """Which of the times t (m,) are times of events, (m,); both are in their order."""
    if not len(times):
        return np.zeros(len(t), dtype=bool)
    at = np.minimum(np.searchsorted(times, t), len(times) - 1)
    return np.asarray(times[at] == t)
