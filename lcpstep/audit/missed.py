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

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.drift import frequency
from lcpstep.audit.motion import Polynomials, basis
from lcpstep.audit.sums import add_up, changes
from lcpstep.kernels import states
from lcpstep.kernels.model import Model
from lcpstep.model import models
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
NODES = 0.5 + 0.5 * np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)])
WEIGHTS = np.array([5.0, 8.0, 5.0]) / 18.0
SAFETY = 2.0  # what is told of the errors found: motions may part a little, and nodes see no more than they see
ROUNDING = 4e-14  # of the positions: what their second differences over a step, times h^2, may be off by
JUMPS = float(Kind.IMPACT), float(Kind.ACCUMULATION), float(Kind.JAM)


def missed(run: Trajectory, m: Model, motion: Polynomials, closed: Mask, cuts: Array) -> Array:
    """An estimate of how far the computed positions are off in each piece, (m, n_q).

    closed : (m, n_c)   which contacts are closed in a piece;  cuts : (k,)   corners
    """
    t, h = np.ascontiguousarray(run.t, dtype=float), np.diff(run.t)
    nodes = Nodes(run, motion)
    f = states.accelerations(m, nodes.t, nodes.q, nodes.v).reshape(nodes.a.shape)
    held = np.any(closed, axis=1) | (run.scene.n_j > 0)
    off = f - nodes.a
    if np.any(held):
        off[held] = free_part(run, closed[held], off[held], nodes, held)
    with np.errstate(all="ignore"):
        noise = ROUNDING * np.max(np.abs(motion.B), axis=1) / (h * h)[:, None]
    off = np.sign(off) * np.maximum(np.abs(off) - noise[:, None], 0.0)
    jump = jumped(run, t)
    place, speed = by_motion(run, motion, f, h, jump)
    place[held], speed[held] = by_rest(off[held], h[held])
    parted = np.searchsorted(cuts, t[:-1], side="right") < np.searchsorted(cuts, t[1:], side="left")
    for x in (place, speed):  # a corner within: its parts are steps of their own, as those beside it
        x[parted] = largest_beside(np.abs(np.where(parted[:, None], 0.0, x)))[parted]
    within = 0.125 * (h * h)[:, None] * np.max(np.abs(off), axis=1)
    place, speed, within = (np.abs(np.nan_to_num(x, posinf=0.0, neginf=0.0)) for x in (place, speed, within))
    gone, marks = np.zeros(place.shape), jump.view(np.uint8)
    first, second, size = np.zeros(gone.shape), np.zeros(gone.shape), np.zeros(run.scene.n_q)
    changes(t, np.ascontiguousarray(run.v), marks, np.ascontiguousarray(cuts), first, second, size)
    add_up(t, marks, place, speed, frequency(run, m, size, second), gone)
    return SAFETY * (gone + within)


class Nodes:
    """The motion at three places of every piece: t (3 m,), q, v (3 m, n_q), a (m, 3, n_q)."""

    def __init__(self, run: Trajectory, motion: Polynomials) -> None:
        h, B, d = np.diff(run.t)[:, None, None], motion.B, motion.degree
        slopes, bends = d * np.diff(B, axis=1), d * (d - 1) * np.diff(B, 2, axis=1)
        with np.errstate(all="ignore"):
            q, v, a = (
                np.matmul(basis(NODES, d - k), x) / h**k for k, x in enumerate((B, slopes, bends))
            )
        n = run.scene.n_q
        self.t = np.ascontiguousarray((run.t[:-1, None] + h[:, 0] * NODES).ravel())
        self.q, self.v = (np.ascontiguousarray(np.nan_to_num(x).reshape(-1, n)) for x in (q, v))
        self.a = a


def by_motion(run: Trajectory, motion: Polynomials, f: Array, h: Array, jump: Mask) -> tuple[Array, Array]:
    """Errors of positions and velocities at the ends of pieces without closed contacts, (m, n_q) each."""
    q, v, h = run.q, run.v, h[:, None]
    moved, turned = np.tensordot(f, WEIGHTS * (1.0 - NODES), (1, 0)), np.tensordot(f, WEIGHTS, (1, 0))
    place = (motion.B[:, -1] - motion.B[:, 0]) - h * (v[:-1] + h * moved)
    speed = np.where(jump[1:, None], 0.0, (v[1:] - v[:-1]) - h * turned)
    return place, speed


def largest_beside(x: Array) -> Array:
    """The larger one of both neighbours, (m, n_q)."""
    out = np.zeros(x.shape)
    out[1:] = x[:-1]
    out[:-1] = np.maximum(out[:-1], x[1:])
    return out


def by_rest(off: Array, h: Array) -> tuple[Array, Array]:
    """The same from f - p'', (m, 3, n_q), which is less exact where steps are short."""
    h = h[:, None]
    moved, turned = np.tensordot(off, WEIGHTS * (1.0 - NODES), (1, 0)), np.tensordot(off, WEIGHTS, (1, 0))
    return h * h * moved, h * turned


def free_part(run: Trajectory, closed: Mask, off: Array, nodes: Nodes, held: Mask) -> Array:
    """What of an acceleration (m, 3, n_q) no force of the closed contacts and joints can give."""
    contacts, joints, tangents = models(run.scene)
    rows = np.repeat(held, len(NODES))
    t, q, v = (np.ascontiguousarray(x[rows]) for x in (nodes.t, nodes.q, nodes.v))
    shut = np.repeat(closed, len(NODES), axis=0)
    parts = [(contacts, shut), (tangents, shut), (joints, np.ones((len(t), joints.n_c), dtype=bool))]
    found = [(*states.responses(x, t, q, v), mask) for x, mask in parts if x.n_c > 0]
    G, MG = (np.concatenate([np.where(x[2][..., None], x[i], 0.0) for x in found], axis=1) for i in (0, 1))
    flat = off.reshape(len(t), -1, 1)
    with np.errstate(all="ignore"):
        force = np.matmul(np.linalg.pinv(np.matmul(G, MG.transpose(0, 2, 1))), np.matmul(G, flat))
    return np.asarray((flat - np.matmul(MG.transpose(0, 2, 1), force)).reshape(off.shape))


def jumped(run: Trajectory, t: Array) -> Mask:
    """At which states velocities may have jumped, (m + 1,)."""
    kinds = np.array(run.impacts["kind"], dtype=float)
    times: Any = np.array(run.impacts["time"], dtype=float)[np.isin(kinds, JUMPS)]
    return np.isin(t, times)
