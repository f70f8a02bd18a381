"""Whether a finished run has been taken along by an obstacle that leaps: a gap that jumps, in time or with the place.

    |q1 - q0| > 2 h (|v0| + |v1|),        g(t1, q1) - g(t0, q0) = G (q1 - q0) + the leap

A table that is held between its entries, a floor with a curb, a period whose ends do not meet: no impact law answers,
since velocities know nothing of it. Methods that put what is closed onto its obstacle put it there over any distance,
whatever the velocities, and no error bar tells: the companion does the same. So steps are looked for that have gone
further than their velocities lead, and on the straight line between their states the place where the gap jumps.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, Scene
from lcpstep.doubts import depth
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
FURTHER = 2.0  # times what the velocities at both ends lead
ROUNDING = 1e-9  # of the coordinates: no way; of how far the run could go: no leap
STEPS = 4  # that are looked at, those that went furthest
JUST_BEFORE = 4 * float(np.finfo(float).eps)  # of a time
HALVINGS = 48  # of a step: down to the resolution of its place
NEAREST = 8  # contacts that are looked at, those that are closed or all but closed after the step
PART = 0.1  # of the way without a velocity, that one leap is at least
STILL_CLOSED = 0.5  # of the leap: a gap below it after the step


def leapt(run: Trajectory) -> str:
    """Where an obstacle has leapt and taken a body along, in words; "" where none was found."""
    contacts: Any = run.scene.contacts
    moves = isinstance(contacts, Contacts) or getattr(contacts, "motion", None) is not None
    puts_back = not hasattr(run.method, "theta") or run.method.projected
    if not (moves and puts_back) or run.status != Status.DONE or len(run.t) < 2:
        return ""
    for k in _carried(run):
        try:
            found = _leap(run.scene, *((float(run.t[i]), run.q[i], run.v[i]) for i in (k, k + 1)))
        except ValueError:  # a callback that fails beside the motion
            continue
        if found is not None and found[2] > ROUNDING * _way(run):
            c, t, size = found
            return (
                f"the gap of contact {c} leaps by {size:.3g} m at t = {t:.9g} s and takes what touches it along "
                f"without a velocity: no law of impact is known there, and the run is wrong; give a "
                f"gap that is continuous"
            )
    return ""


def _way(run: Trajectory) -> float:
    """How far the speeds of the run, or forces that nothing holds, would lead in its span [m]."""
    from lcpstep.errorbar.distance import fall
    from lcpstep.model import looked_at

    return float(run.t[-1] - run.t[0]) * (float(np.max(np.abs(run.v))) + fall(looked_at(run.scene), run))


def _carried(run: Trajectory) -> Any:
    """The states after which coordinates go furthest beyond what their velocities lead, a few."""
    h, speed = np.diff(run.t)[:, None], np.abs(run.v)
    beyond = np.abs(np.diff(run.q, axis=0)) - FURTHER * h * (speed[1:] + speed[:-1])
    beyond -= ROUNDING * np.max(np.abs(run.q), axis=0)
    most = np.max(beyond, axis=1)
    k = np.argsort(most)[-STEPS:][::-1]
    return np.sort(k[most[k] > 0.0])


def _leap(
    scene: Scene, start: tuple[float, Array, Array], end: tuple[float, Array, Array]
) -> tuple[int, float, float] | None:
    """Contact, time and size of the leap of a gap between two states, if there is one that is still closed."""
    (t, q, v), way = start, end[1] - start[1]
    # A state may be kept at the very time of a leap
    t = max(scene.t_span[0], t - JUST_BEFORE * max(abs(t), end[0] - t))

    def gaps(share: float) -> Array:
        return depth.gaps(scene, [(t + share * (end[0] - t), q + share * way, v)])[0]

    begun, ended = gaps(0.0), gaps(1.0)
    for c in map(int, np.argsort(ended)[:NEAREST]):
        straight = float(depth.normal(scene, c, start) @ way)
        if abs(ended[c] - begun[c] - straight) <= PART * abs(straight):
            continue
        low, high, before, after = 0.0, 1.0, begun[c], ended[c]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if not low < middle < high:
                break
            now, half = gaps(middle)[c], 0.5 * (high - low) * straight
            if abs(now - before - half) >= abs(after - now - half):
                high, after = middle, now
            else:
                low, before = middle, now
        size = abs(after - before)
        if size > PART * abs(straight) and ended[c] < STILL_CLOSED * size:
            return c, t + high * (end[0] - t), size
    return None
