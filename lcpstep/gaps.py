"""Smallest and largest gap of every contact, or of every joint, over a motion; gaps that no motion keeps open."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, Scene
from lcpstep.kernels import states
from lcpstep.model import joint_model, model

Array = NDArray[np.float64]
PORTION = 1 << 20  # gaps at a time
CERTAIN = 1e-9  # relative residual of a combination of gaps that is said to be none of the coordinates


def lowest_and_highest(
    scene: Scene, t: Array, q: Array, v: Array, *, joints: bool = False
) -> tuple[Array, Array]:
    """Smallest and largest gap (n_c,) over states t (n,), q and v (n, n_q); of the joints where asked for [m]."""
    constraints: Any = (
        (None if scene.joints is None else scene.joints.as_contacts()) if joints else scene.contacts
    )
    n = 0 if constraints is None else constraints.n_c
    low, high = np.full(n, np.inf), np.full(n, -np.inf)
    if n == 0 or len(t) == 0:
        return np.zeros(n), np.zeros(n)
    if joints and getattr(scene.joints, "pattern", None) is not None:
        return _of_joints(scene, t, q, v)
    if isinstance(constraints, LinearContacts) and (constraints.motion is None or constraints.sparse):
        _flat(constraints, np.array(scene.p), t, q, v, low, high)
    else:
        m = (joint_model if joints else model)(scene)
        return states.extremes(m, *(np.ascontiguousarray(x, dtype=float) for x in (t, q, v)))
    return low, high


def _of_joints(scene: Scene, t: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """The same of the joints of a large system, whose Jacobian is not asked for."""
    from lcpstep.kernels.function import Function
    from lcpstep.model import c_functions

    joints: Any = scene.joints
    addresses, _kept = c_functions(scene, joints={"gap": joints.gap})
    shape = (scene.n_j,)
    gap = Function(addresses["joints"]["gap"], np.array(scene.p), scene.n_q, scene.n_q, shape)
    low, high, g = np.full(shape, np.inf), np.full(shape, -np.inf), np.zeros((1, *shape))
    for k in range(len(t)):
        gap.sample(t[k : k + 1], np.ascontiguousarray(q[k]), np.ascontiguousarray(v[k]), g)
        np.minimum(low, g[0], out=low)
        np.maximum(high, g[0], out=high)
    return low, high


def _flat(contacts: Any, p: Array, t: Array, q: Array, v: Array, low: Array, high: Array) -> None:
    rows = max(1, PORTION // contacts.n_c)
    for first in range(0, len(t), rows):
        part = slice(first, first + rows)
        g = (contacts.G @ q[part].T).T + contacts.offset
        if contacts.motion is not None:
            s = np.zeros((contacts.n_c, 3))
            for k in range(first, min(first + rows, len(t))):
                contacts.motion(t[k], q[k], v[k], p, s)
                g[k - first] -= s[:, 0]
        np.minimum(low, g.min(axis=0), out=low)
        np.maximum(high, g.max(axis=0), out=high)


def closing_in(scene: Scene, t: float, q: Array, contacts: list[int]) -> list[int]:
    """Those of some closed contacts whose obstacles approach each other, so that no velocity keeps their gaps open.

    By the lemma of J. Farkas (Theorie der einfachen Ungleichungen, 1902) G v + g_t >= 0 has no solution v where there
    are weights y >= 0 with G^T y = 0 and g_t^T y < 0: what is left between the obstacles of the contacts with y > 0
    depends on no coordinate, and shrinks; as does a gap alone whose row is zero. Joints are equations, whose weights
    have either sign.
    """
    from scipy.optimize import nnls

    G, rate = _rows(scene.contacts, scene, t, q, contacts)
    if scene.joints is not None:
        J, turn = _rows(scene.joints.as_contacts(), scene, t, q, list(range(scene.n_j)))
        G, rate = np.vstack([G, J, -J]), np.concatenate([rate, turn, -turn])
    size = np.linalg.norm(G, axis=1)
    alone = [c for c, g, u in zip(contacts, size, rate, strict=False) if g == 0.0 and u < 0.0]
    if alone:  # as in the middle of a bowl that shrinks
        return alone
    size = np.where(size > 0.0, size, np.inf)
    G, rate = G / size[:, None], rate / size
    fastest = float(np.max(np.abs(rate), initial=0.0))
    if fastest == 0.0:
        return []
    weights, residual = nnls(np.vstack([G.T, rate / fastest]), np.append(np.zeros(scene.n_q), -1.0))
    if residual > CERTAIN * np.sum(weights):
        return []
    return [c for c, y in zip(contacts, weights, strict=False) if y > 0.0]


def _rows(constraints: Any, scene: Scene, t: float, q: Array, rows: list[int]) -> tuple[Array, Array]:
    """Jacobian of some gaps, and their velocities at rest."""
    at = t, np.array(q), np.zeros(len(q)), np.array(scene.p)
    if isinstance(constraints, LinearContacts):
        chosen: Any = cast(Any, constraints.G)[rows]
        G = chosen.toarray() if constraints.sparse else chosen
    else:
        everything = np.zeros((constraints.n_c, len(q)))
        constraints.jacobian(*at, everything)
        G = everything[rows]
    return np.array(G, dtype=float), constraints.state(*at)[1][rows]


def no_way_out(scene: Scene, t: float, q: Array, contacts: list[int]) -> str:
    """In words, why a problem of some closed contacts has no solution, where that is in the scene; else ""."""
    between = closing_in(scene, t, q, contacts) if contacts else []
    if not between:
        return ""
    if len(between) == 1:
        return f"the obstacle of contact {between[0]} closes in, and its gap depends on no coordinate here"
    return f"the obstacles of contacts {between} approach each other with nothing left between them"
