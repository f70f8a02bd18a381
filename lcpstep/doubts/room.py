"""Whether an obstacle has left any room to the body that a finished run has kept inside of it.

From a kept state with a gap g(t, q) < 0 the gap is climbed along its gradient G, by steps twice as long as Newton's
towards zero, each halved until the gap grows. Where the climb ends below zero at q* with

    g(t, q*) + R |G(t, q*)| < 0,     R = how far the coordinates went,

a gap that bends downwards, as that of a bowl, is negative everywhere within R of q*: it has closed upon the body.
No motion goes on from there, whatever the steps of a method have made of it. The same, a little later, is asked of a
run that was held on such an obstacle by ever shorter steps (`closes_upon`).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, Scene
from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts import depth
from lcpstep.kernels.looks import lies_inside
from lcpstep.kernels.states import gaps_at
from lcpstep.model import looked_at
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
LOOKS = 64  # kept states whose gaps are looked at
CLIMBS = 8  # of them, the deepest, from which the gap is climbed
STEPS, HALVINGS = 60, 60  # of a climb, and of each of its steps
SHALLOW = 1e-2  # of R: what steps lie inside of an obstacle anyway, from which nothing is climbed
ROUNDING = 1e-9  # of R, and of the coordinates: no depth
SOON = 1e-6  # of the time since the start: when a run that steps ever shorter would have gone on
TOUCHES = 1e-3  # of R: gaps of contacts that may be closed


def no_room(run: Trajectory) -> str:
    """Which obstacle of a scene with `Contacts` leaves no room, in words; "" where none is known."""
    if run.status != Status.DONE or len(run.t) < 2:
        return ""
    m = looked_at(run.scene)
    deep = lies_inside(m, run.t, run.q, LOOKS, SHALLOW, False)
    cause()  # a callback that fails at rest, as the run has not asked it
    forget()
    if not deep:
        return ""
    k = depth.spread(0, len(run.t) - 1, LOOKS)
    with np.errstate(all="ignore"):
        g = gaps_at(m, run.t[k], np.ascontiguousarray(run.q[k]))
    cause()
    forget()
    seen = np.array([run.scene.q0, *run.q[k]])  # what is kept may be but a rest
    reach = float(np.linalg.norm(np.ptp(seen, axis=0)))
    lowest, least = g.min(axis=1), ROUNDING * max(reach, float(np.max(np.linalg.norm(seen, axis=1))))
    for i in [i for i in np.argsort(lowest)[:CLIMBS] if lowest[i] < -SHALLOW * reach]:
        c, at = int(np.argmin(g[i])), float(run.t[k[i]])
        try:
            best = _climbed(run.scene, at, run.q[k[i]], c, reach)
        except ValueError:  # a callback that fails beside the motion
            continue
        if best < -least:
            return (
                f"the obstacle of contact {c} leaves no room at t = {at:.9g} s, where its gap is at most {best:.3g} "
                f"m: the motion ends before that, and the run is wrong from there on"
            )
    return ""


def closes_upon(scene: Scene, t: float, q: Array) -> str:
    """Which obstacle leaves no room just after time t to a body that touches it at q, in words; "" where none."""
    reach = float(np.linalg.norm(q - np.asarray(scene.q0, dtype=float)))
    if not isinstance(scene.contacts, Contacts) or not 0.0 < reach < np.inf:
        return ""
    soon = t + SOON * (t - scene.t_span[0])
    try:
        g = depth.gaps(scene, [(t, q, np.zeros_like(q))])[0]
        for c in np.flatnonzero(np.abs(g) <= TOUCHES * reach):
            if _climbed(scene, soon, q, int(c), reach) < 0.0:
                return f"the obstacle of contact {c} closes in, and leaves no room"
    except ValueError:  # a callback that fails beside the motion
        pass
    return ""


def _climbed(scene: Scene, t: float, q: Array, c: int, reach: float) -> float:
    """The largest gap within reach where that is below zero; 0 where there is room, or where it is not known."""
    still = np.zeros_like(q)
    g, G = depth.gaps(scene, [(t, q, still)])[0, c], depth.normal(scene, c, (t, q, still))
    for _ in range(STEPS):
        if g >= 0.0:
            return 0.0
        most = g + reach * float(np.linalg.norm(G))
        if most < 0.0:
            return float(most)
        way = -2.0 * g / float(G @ G) * G
        for _ in range(HALVINGS):
            higher = depth.gaps(scene, [(t, q + way, still)])[0, c]
            if higher > g:
                break
            way = 0.5 * way
        else:
            return 0.0
        q, g = q + way, higher
        G = depth.normal(scene, c, (t, q, still))
    return 0.0
