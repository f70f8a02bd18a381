"""Whether a finished run has gone through an obstacle that has no inside: a gap that is zero and positive beyond.

    g = |x|, or the distance of two points:      G turns about where g = 0, and no gap falls through zero

Such a gap is never negative, so that whatever moves is admissible, and no method finds an impact: bodies go through
one another. The gradients at some states tell on which side a motion is; where one has turned about, the states are
sought between which it has, and the gap on the straight line between them. A sharp tip that is flown over at next to
no height turns about, too, but there is an inside below it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts
from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts.depth import spread
from lcpstep.kernels.model import Model
from lcpstep.kernels.states import gaps_at, gradients_at
from lcpstep.model import looked_at
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
LOOKS = 64  # states that are looked at,
ENTRIES = 2**18  # with so many entries of gradients at most
MOST = 8  # times that a gradient has turned about, of which it is asked where
ABOUT = -0.9  # of the product of the gradients at both ends of a step: not a body that goes round another
NOTHING = 1e-6  # of the gaps there: zero between them
HALVINGS = 48  # of a step


def passed_through(run: Trajectory) -> str:
    """Which gap is positive on both sides of its obstacle, and when the motion has gone through, in words; ""."""
    scene, last = run.scene, len(run.t) - 1
    if not isinstance(scene.contacts, Contacts) or run.status != Status.DONE or last < 1:
        return ""
    told = _told(run, looked_at(scene), min(LOOKS, ENTRIES // (scene.n_c * scene.n_q)))
    cause()  # a callback that fails at a state that the run has not asked it for
    forget()
    return told


def _told(run: Trajectory, m: Model, looks: int) -> str:
    """The same, of a model, by so many looks."""
    k = spread(0, len(run.t) - 1, looks)
    G = _gradients(m, run.t[k], run.q[k])
    for i, c in np.argwhere(np.sum(G[1:] * G[:-1], axis=2) < 0.0)[:MOST]:
        time = _zero(m, run, _between(m, run, int(k[i]), int(k[i + 1]), int(c), G[i, c]), int(c))
        if time is not None:
            return (
                f"the gap of contact {c} falls to zero at t = {time:.9g} s and is positive beyond, so that the "
                f"motion goes through its obstacle: give a gap that is negative inside"
            )
    return ""


def _gradients(m: Model, t: Array, q: Array) -> Array:
    """Those of all gaps at some states, (n, n_c, n_q)."""
    return np.asarray(gradients_at(m, np.ascontiguousarray(t), np.ascontiguousarray(q)))


def _between(m: Model, run: Trajectory, low: int, high: int, c: int, G: Array) -> int:
    """The state after which a gradient that is G at `low` has turned about, for the first or another time."""
    while high - low > 1:
        k = (low + high) // 2
        if float(_gradients(m, run.t[k : k + 1], run.q[k : k + 1])[0, c] @ G) > 0.0:
            low = k
        else:
            high = k
    return low


def _zero(m: Model, run: Trajectory, k: int, c: int) -> float | None:
    """When the gap is zero between a state and the next, where it is positive and turns about; else None."""
    (t, later), (start, end) = run.t[k : k + 2], run.q[k : k + 2]
    first, last = _gradients(m, run.t[k : k + 2], run.q[k : k + 2])[:, c]
    if not first @ last < ABOUT * np.linalg.norm(first) * np.linalg.norm(last):
        return None
    least = NOTHING * float(
        np.max(gaps_at(m, run.t[k : k + 2], np.ascontiguousarray(run.q[k : k + 2]))[:, c])
    )
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        share = 0.5 * (low + high)
        at, q = np.array([t + share * (later - t)]), (start + share * (end - start))[None]
        gap = float(gaps_at(m, at, q)[0, c])
        if abs(gap) <= least and (gap < 0.0 or not _has_inside(m, at, q, c, first + last, end - start)):
            return float(at[0])  # there may be no gradient there
        if _gradients(m, at, q)[0, c] @ first > 0.0:
            low = share
        else:
            high = share
    return None


def _has_inside(m: Model, at: Array, q: Array, c: int, out: Array, way: Array) -> bool:
    """Whether a gap is negative somewhere straight below a place; `out`: gradients of both sides together.

    As under the tip of a needle that is only just flown over. The two sides of |x| have none together.
    """
    size = float(np.linalg.norm(out))
    if not size > 0.0:
        return False
    far = float(np.linalg.norm(way)) / size * 0.5 ** np.arange(HALVINGS)
    below = np.ascontiguousarray(q - far[:, None] * out)
    return bool(np.min(gaps_at(m, np.repeat(at, HALVINGS), below)[:, c]) < 0.0)
