"""Smallest and largest gap of every contact, or of every joint, over the states of a motion."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, Scene
from lcpstep.compiled import compiled
from lcpstep.dynamics import gaps
from lcpstep.model import joint_model, model

Array = NDArray[np.float64]
PORTION = 1 << 20  # gaps at a time


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
    if isinstance(constraints, LinearContacts) and (constraints.motion is None or constraints.sparse):
        _flat(constraints, np.array(scene.p), t, q, v, low, high)
    else:
        m, fast = (joint_model if joints else model)(scene)
        (compiled(extremes) if fast else extremes)(m, t, q, v, np.zeros(n), low, high)
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


def extremes(m: Any, t: Any, q: Any, v: Any, g: Any, low: Any, high: Any) -> None:
    """Kernel: the smallest and the largest value of every gap."""
    for k in range(len(t)):
        gaps(m, t[k], q[k], v[k], g)
        for c in range(len(g)):
            low[c], high[c] = min(low[c], g[c]), max(high[c], g[c])
