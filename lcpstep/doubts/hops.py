"""Whether contacts of a finished run of time-stepping hop faster than its steps can follow.

    h |u-| > SHARE way,    h |u-| < MOST gone,    h |u-| > AMONG |G| largest,    m (u-)^2 / 2 > ENERGY T,

of impacts within two steps after the one before; `gone` is |G| (how far the coordinates went), way that or u+ dt / 2
of a longer hop, `largest` how far any coordinate went, T the largest kinetic energy, m = p / (u+ - u-). Time-stepping
strikes a contact in every second step at most, so that shorter hops come out as hops of two steps, however short they
are. Low ones do no harm: what rests on the whole does so, and places are off by their height, an error of the order.
So it is with a body that does nothing but hop, in a slit without clearance. But one that comes a good part of all its
way in a step, and is thrown back in the next, time and again, goes where no step sees it go: between walls that come
together, what throws it out again is the sum of thousands of impacts.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.doubts.depth import fixed_step, largest_energy, normal
from lcpstep.trajectory import Kind, Status, Trajectory

LEAST = 8  # hops
SHORT = 2.5  # steps, between one impact and the next
SHARE, MOST, AMONG = 0.1, 0.5, 0.02  # of ways, in a step; the second of the median
# Of the largest kinetic energy; what seems more are the forces of a step, and rounding hops
ENERGY = 0.01, 2.0
KEPT = 16  # states that tell how far the coordinates went


def too_short(run: Trajectory) -> str:
    """Which contact hops too fast for the steps, in words; "" where none does."""
    h, log = _step(run), run.impacts
    if h == 0.0 or run.status != Status.DONE or len(log) <= LEAST or len(run.t) < KEPT:
        return ""
    # No event lies between two of a contact that hops
    if np.count_nonzero(np.diff(log.time) < SHORT * h) < LEAST:
        return ""
    log = log[log.kind == Kind.IMPACT]
    log = log[np.argsort(log.contact, kind="stable")]
    again = np.diff(log.contact) == 0
    short = 1 + np.flatnonzero(again & (np.diff(log.time) < SHORT * h))
    often = np.flatnonzero(np.bincount(log.contact[short], minlength=1) >= LEAST)
    return next((words for c in often if (words := _hops(run, h, log[log.contact == c]))), "")


def _hops(run: Trajectory, h: float, log: Any) -> str:
    """The same of one contact, by its impacts."""
    c, since = int(log.contact[0]), np.diff(log.time)
    gone, among = _ways(run, c)
    way = max(gone, 0.5 * float(np.max(since * log.after[:-1])))
    struck = log[1:][since < SHORT * h]
    step = h * -struck.before
    told = (step > SHARE * way) & (step > AMONG * among)
    struck, step = struck[told], step[told]
    if len(struck) < LEAST:
        return ""
    own = 0.5 * struck.impulse * struck.before**2 / (struck.after - struck.before)
    least, most = np.array(ENERGY) * largest_energy(run)
    told = (own > least) & (own < most)
    struck, step = struck[told], step[told]
    if len(struck) < LEAST or not np.median(step) < MOST * gone:
        return ""
    k = int(np.argmax(step))
    return (
        f"contact {c} is struck in every second step {len(struck)} times, at t = {struck.time[k]:.9g} s so fast that "
        f"it comes {step[k] / way:.2g} of all its way in a step: steps are too long for this motion"
    )


def _ways(run: Trajectory, c: int) -> tuple[float, float]:
    """How far the coordinates went towards a contact, or away from it; and how far had all gone as far as any."""
    scene = run.scene
    far = np.maximum(scene.q0, run.q.max(axis=0)) - np.minimum(scene.q0, run.q.min(axis=0))
    try:
        G = np.abs(normal(scene, c, (scene.t_span[0], np.asarray(scene.q0), np.asarray(scene.v0))))
    except ValueError:  # a callback that fails beside the motion
        return np.inf, np.inf
    return float(G @ far), float(np.sum(G) * np.max(far))


def _step(run: Trajectory) -> float:
    """The step of a run of time-stepping, 0 of other methods and of steps by a tolerance."""
    return fixed_step(run.method) if hasattr(run.method, "theta") else 0.0
