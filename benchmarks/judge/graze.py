"""Until when a motion can be foretold where a contact comes to its surface with no speed.

    u = sqrt(2 a e),      e = -min g,   a = g'' there

is the speed of impact where the gap would go to -e; where it stays positive there is none. So an error E of the gap
decides whether there is an impact of up to sqrt(2 a E), whose derivative by E is infinite at zero: what rounding does
is its root. No companion disturbed by as little tells that where the motion starts at rest on the surface: it comes
back as exactly closed as the motion itself. Who comes from a hop that is itself as low as E does not graze.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from benchmarks.judge import physics
from benchmarks.judge.describe import Description

SAMPLES, HALVINGS = 2000, 50
AFAR = 100.0  # errors of the gap
ROUNDING = 1e-12  # of the fastest gap velocity: what contacts at rest have


def grazes(d: Description, motion: Any, looks: Any, allowed: Any) -> float:
    """The first time at which errors allowed of places (at the times `looks`) decide whether a contact strikes."""
    if not d.contacts:
        return np.inf
    times = np.union1d(motion.t, np.linspace(motion.t[0], motion.t[-1], SAMPLES))
    try:
        g, u, error = _seen(d, motion, times, looks, allowed)
        still = ROUNDING * np.max(np.abs(u))
        before, c = np.nonzero(_returns(g, u, AFAR * error, still))
        if not len(before):
            return np.inf
        low, high = times[before], times[before + 1]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if np.all((middle == low) | (middle == high)):
                break
            falls = _of(c, _seen(d, motion, middle, looks, allowed)[1]) < -still
            low, high = np.where(falls, middle, low), np.where(falls, high, middle)
        least, speed, error = (_of(c, x) for x in _seen(d, motion, low, looks, allowed))
    except (IndexError, ValueError):  # a finding of its own
        return np.inf
    braked = (speed - u[before, c]) / np.where(low > times[before], low - times[before], np.inf)
    slows = np.abs(speed) < 0.5 * np.abs(u[before, c])  # else what brakes it is rounding
    grazing = slows & (least <= error) & (0.5 * speed**2 <= braked * error)
    return float(np.min(low[grazing], initial=np.inf))


def _seen(d: Description, motion: Any, times: Any, looks: Any, allowed: Any) -> tuple[Any, Any, Any]:
    """Gaps, gap velocities, and what errors allowed of places make of gaps, each (times, contacts)."""
    q, v = motion.at(times)
    late = np.minimum(np.searchsorted(looks, times), len(looks) - 1)
    error = allowed[late][:, None] * np.sum(np.abs(physics.jacobians(d, q)), axis=-1)
    return physics.gaps(d, times, q), physics.rates(d, times, q, v), error


def _of(c: Any, x: Any) -> Any:
    """Of each row the number of one contact."""
    return np.take_along_axis(x, c[:, None], axis=1)[:, 0]


def _returns(g: Any, u: Any, far: Any, still: float) -> Any:
    """Whether a contact ends a fall from farther than `far` before the next sample, at all samples but the last."""
    ends = (u[:-1] < -still) & (u[1:] >= -still)
    k = np.arange(len(g))[:, None]
    last = np.maximum.accumulate(np.where(g > far, k, -1), axis=0)  # sample that was afar
    ended = np.full(g.shape, -1)  # before which a fall ended last
    ended[1:] = np.maximum.accumulate(np.where(ends, k[:-1], -1), axis=0)
    return ends & (last > ended)[:-1]
