"""Valleys of the ground that are given as one gap: where a run stands at the kink of one.

At a kink the row G = dg/dq jumps with the place. Along a direction d across it the gap is concave there where

    (G(q + d) - G(q - d)) d < 0,

and the ground a valley: what comes to rest in it is held by forces along both rows, and one contact has one force.
Two contacts have two. That the row jumps, and does not turn fast, is seen by halving.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, Scene, checks
from lcpstep.doubts import depth

Array = NDArray[np.float64]
NEAR = 1e-6  # of the coordinates, and of a metre: how far from the state a kink may be
HALVINGS = 32
LEAST = 1e-9  # of the row: that it jumps by
SHARE = 0.5  # of what the row turns by between two places, that is left of a jump


def valley(scene: Scene, t: float, q: Array, v: Array) -> str:
    """Which gap has the kink of a valley at a state that touches it, in words; "" where none has."""
    contacts = scene.contacts
    if not isinstance(contacts, Contacts):
        return ""
    try:
        g = depth.gaps(scene, [(t, q, v)])[0]
        for c in range(contacts.n_c):
            G = depth.normal(scene, c, (t, q, v))
            for d in directions(q, v):
                if abs(g[c]) <= np.abs(G) @ np.abs(d) and is_concave_kink(scene, c, t, q, v, d):
                    return (
                        f"the gap of contact {c} has a kink at q = {checks.shown(q)}, the bottom of a valley, where "
                        f"one contact cannot hold a body on both sides; expected two contacts, one for each side"
                    )
    except ValueError:  # a callback that fails beside the motion
        pass
    return ""


def directions(q: Array, v: Array) -> Iterator[Array]:
    """Along each coordinate, and along the velocity."""
    near = NEAR * (1.0 + np.abs(q))
    yield from np.diag(near)
    speed = float(np.max(np.abs(v)))
    if speed > 0.0:
        yield float(np.min(near)) / speed * v


def is_concave_kink(scene: Scene, c: int, t: float, q: Array, v: Array, d: Array) -> bool:
    """Whether the row of a contact jumps between q - d and q + d, so that its gap is concave along d."""

    def row(x: float) -> Array:
        return depth.normal(scene, c, (t, q + x * d, v))

    low, high = -1.0, 1.0
    before, later = row(low), row(high)
    whole = float(np.max(np.abs(later - before)))
    if whole <= LEAST * float(np.max(np.abs(before))):
        return False
    for _ in range(HALVINGS):
        x = 0.5 * (low + high)
        middle = row(x)
        if np.max(np.abs(middle - before)) > np.max(np.abs(later - middle)):
            high, later = x, middle
        else:
            low, before = x, middle
    jump = later - before
    return bool(np.max(np.abs(jump)) >= SHARE * whole and jump @ d < 0.0)
