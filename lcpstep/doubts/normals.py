"""Whether the obstacles that a finished run has met have a normal there: a gradient G of the gap that is not zero.

    g = d^m, m > 1, for the distance d:      |G| = m d^(m - 1), zero on the obstacle

Such a gap is met nowhere with a speed u = G v, so that no law of impact answers, and no method knows how deep a step
is inside, g / |G|. At events of each contact the gradient is compared with that a little further along it, as far as
states were kept near them. That one points the same way; on an obstacle that is only narrow, a needle, it has turned.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lcpstep.callbacks.faults import cause, forget
from lcpstep.kernels.model import Model
from lcpstep.kernels.states import gradients_at
from lcpstep.model import looked_at
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
LOOKS = 64  # states that tell how far the motion goes
NEAR = 1e-2  # of the way that the coordinates go: where the gradient is looked at again
VANISHES = 1e-2  # of that gradient
SAME_WAY = 0.9  # of a gradient, that is seen along the one at the obstacle
MET = (Kind.IMPACT, Kind.ACCUMULATION, Kind.STICK)


def no_normal(run: Trajectory) -> str:
    """Which contact has struck where its gap has no gradient, in words; "" where none that was looked at."""
    if run.status != Status.DONE or len(run.t) < 2 or len(run.impacts) == 0:
        return ""
    log = run.impacts[np.isin(run.impacts.kind, MET)]
    log = log[(log.time >= run.t[0]) & (log.time <= run.t[-1])]
    seen = np.array([run.scene.q0, *run.q[:: len(run.q) // LOOKS + 1]])
    aside = NEAR * float(np.linalg.norm(np.ptp(seen, axis=0)))
    if aside == 0.0 or len(log) == 0:
        return ""
    m, told = looked_at(run.scene), ""
    for c in np.unique(log.contact):
        times = log.time[log.contact == c]
        for k in {int(np.searchsorted(run.t, t, side="right")) - 1 for t in (times[0], times[-1])}:
            if not told and _vanishes(m, int(c), run.t[k], run.q[k], aside):
                told = (
                    f"the gap of contact {c} has no gradient where it is met, at t = {run.t[k]:.9g} s, and no law of "
                    f"impact is known there: give a gap that grows in proportion to the distance"
                )
    cause()  # a callback that fails beside the motion
    forget()
    return told


def _vanishes(m: Model, c: int, t: float, q: Array, aside: float) -> bool:
    """Whether the gradient of a gap at q is far smaller than at a distance along it."""
    G = _gradient(m, c, t, q)
    here = float(np.linalg.norm(G))
    if here == 0.0:
        return True
    n = G / here
    further = _gradient(m, c, t, q + aside * n)
    size = float(np.linalg.norm(further))
    return here < VANISHES * size and float(n @ further) > SAME_WAY * size


def _gradient(m: Model, c: int, t: float, q: Array) -> Array:
    return np.asarray(gradients_at(m, np.array([t]), np.ascontiguousarray(q)[None])[0, c])
