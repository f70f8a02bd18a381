"""Gaps, forces and energy of a described scene, in numpy and from the equations alone: nothing of the library's."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.optimize import linprog

from benchmarks.judge import callbacks as f
from benchmarks.judge.describe import Description

wave = np.vectorize(f.moved, otypes=[float])


def _bent(d: Description, q: Any) -> Any:
    """r(q) of every contact and its derivative by |q|^2/2, (..., contacts)."""
    square = np.sum(q * q, axis=-1)[..., None]
    rounds = d.row("round", d.contacts)
    root = np.sqrt(rounds**2 + square)
    with np.errstate(divide="ignore"):
        slope = np.where(rounds > 0.0, 1.0 / root, 1.0)
    return np.where(rounds > 0.0, root, 0.5 * square), slope


def gaps(d: Description, t: Any, q: Any) -> Any:
    """Gaps (..., contacts) at times (...) and coordinates (..., n)."""
    g = q @ np.array(d.G).T + d.row("offset", d.contacts)
    if d.curved:
        g = g + d.row("bend", d.contacts) * _bent(d, q)[0]
    return g - obstacles(d, t, 0)


def obstacles(d: Description, t: Any, order: int) -> Any:
    """s, s' or s'' of every contact, (..., contacts)."""
    t = np.asarray(t, dtype=float)[..., None]
    if not any(d.amplitude):
        return np.zeros((*t.shape[:-1], d.contacts))
    size, phase = d.row("amplitude", d.contacts), d.row("phase", d.contacts)
    return size * wave(d.omega * t + phase, d.omega, float(d.form), order)


def jacobians(d: Description, q: Any) -> Any:
    """G (..., contacts, n)."""
    rows = np.broadcast_to(np.reshape(d.G, (d.contacts, d.n)), (*q.shape[:-1], d.contacts, d.n))
    if not d.curved:
        return rows
    return rows + (d.row("bend", d.contacts) * _bent(d, q)[1])[..., None] * q[..., None, :]


def joint_rows(d: Description, q: Any) -> Any:
    """J (..., joints, n)."""
    return np.array(d.J) + d.row("joint_bend", len(d.J))[:, None] * q[..., None, :]


def swinging(d: Description, q: Any, forces: Any) -> float:
    """Frequency, or rate of growth, of what round joints carry, at a place and forces of the joints [rad/s].

    Along its tangents N a joint (bend/2) |q|^2 pulls back with force x bend: w^2 = |sum force bend| / (N^T M N).
    """
    rows = joint_rows(d, q)
    _, sizes, turned = np.linalg.svd(rows)
    N = turned[int(np.sum(sizes > 0.0)) :].T
    if not N.size:
        return 0.0
    least = float(np.linalg.eigvalsh(N.T @ masses(d, q) @ N)[0])
    return float(np.sqrt(abs(forces @ d.row("joint_bend", len(d.J))) / least))


def rates(d: Description, t: Any, q: Any, v: Any) -> Any:
    """Gap velocities (..., contacts)."""
    return np.einsum("...ij,...j->...i", jacobians(d, q), v) - obstacles(d, t, 1)


def sliding(d: Description, t: Any, v: Any) -> Any:
    """Sliding velocities (..., contacts), zero without friction."""
    if not d.T:
        return np.zeros((*np.shape(v)[:-1], d.contacts))
    t = np.asarray(t, dtype=float)[..., None]
    sway = d.row("sway", d.contacts) * np.cos(d.omega * t)
    return v @ np.array(d.T).T + d.row("slip", d.contacts) + sway


def masses(d: Description, q: Any) -> Any:
    """M(q) (..., n, n)."""
    b = d.row("b")
    return d.matrix("M") + np.asarray(along_b(d, q))[..., None, None] * np.outer(b, b)


def along_b(d: Description, q: Any) -> Any:
    """The part of M(q) that turns with the place, m in m(q) b b^T, (...)."""
    return d.spread * (1.0 + 0.5 * np.sin(q @ d.row("b")))


def forces(d: Description, t: Any, q: Any, v: Any) -> Any:
    """Everything on the right-hand side but the contacts and the frame, (..., n)."""
    t, b = np.asarray(t, dtype=float)[..., None], d.row("b")
    s, rate = q @ b, v @ b
    along = d.pendulum * np.sin(s) + 0.25 * d.spread * np.cos(s) * rate**2
    harmonic = d.row("cosine") * np.cos(d.force_omega * t) + d.row("sine") * np.sin(d.force_omega * t)
    linear = q @ d.matrix("K") + v @ d.matrix("C")
    return d.row("constant") + harmonic - linear - np.asarray(along)[..., None] * b


def energy(d: Description, q: Any, v: Any) -> tuple[Any, Any]:
    """Kinetic energy, and potential energy of constant forces, springs and pendulum, each (...)."""
    b = d.row("b")
    kinetic = 0.5 * (np.sum(v @ d.matrix("M") * v, axis=-1) + along_b(d, q) * (v @ b) ** 2)
    springs = 0.5 * np.sum(q @ d.matrix("K") * q, axis=-1)
    return kinetic, springs - q @ d.row("constant") - d.pendulum * np.cos(q @ b)


def fed(d: Description) -> bool:
    """Whether something may put energy into the scene."""
    return any(d.cosine) or any(d.sine) or d.moving or d.belts


def room(d: Description, t: float) -> float:
    """How much room flat contacts leave at a time: the least y g >= 0 over y >= 0 with y G = 0 and sum y = 1.

    Such a sum of gaps is that of the obstacles alone; infinite where there is no such y, and for bent contacts.
    """
    if d.curved or not d.contacts:
        return np.inf
    G = np.array(d.G)
    open_by = d.row("offset", d.contacts) - obstacles(d, t, 0)
    rows, right = np.vstack([G.T, np.ones(len(G))]), np.append(np.zeros(d.n), 1.0)
    found = linprog(open_by, A_eq=rows, b_eq=right)
    return float(found.fun) if found.success else np.inf


def highest(d: Description, t: float) -> Any:
    """The largest gap of each contact at any place: that of a dome, whose row is less than its bend (contacts,).

    Along its row a gap is |G| x + bend r(x), largest where the slopes are opposite; else it has no bound.
    """
    found = np.full(d.contacts, np.inf)
    if not d.curved:
        return found
    row, bend, size = (
        np.linalg.norm(np.array(d.G), axis=1),
        d.row("bend", d.contacts),
        d.row("round", d.contacts),
    )
    base = d.row("offset", d.contacts) - obstacles(d, np.array(t), 0)
    for c in np.flatnonzero(bend < 0.0):
        if size[c] == 0.0:
            found[c] = base[c] - 0.5 * row[c] ** 2 / bend[c]
        elif row[c] < -bend[c]:
            found[c] = base[c] - size[c] * np.sqrt(bend[c] ** 2 - row[c] ** 2)
    return found
