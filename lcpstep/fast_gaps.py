"""Gaps that turn faster than a run has looked, as samples along its motion show.

What turns fast with the place, a bump of the ground, is not known before the run. From some of the kept states the
gap is followed straight on. Within a step h of the run it can leave the straight line through its ends by about

    h^2 |g''| / 8

where it turns more slowly than that; where this is far more than the gap does leave it, over several steps, the gap
turns back within the step, and the run could have passed over an event. A bump that no sample meets is not seen; for
certainty there is the audit (`lcpstep.audit`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.depth import normal
from lcpstep.faults import cause, forget
from lcpstep.kernels.states import gaps_at
from lcpstep.model import model
from lcpstep.turns.source import GOLDEN

Array = NDArray[np.float64]
PER, LEAST, MOST = 8, 256, 2048  # evaluations of the forces per look, and how many looks there are
CLOSER = 8  # of them, where the gap bends most
AROUND = np.array(
    [-2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
)  # steps after the state, between which the gap leaves its line
NEAR = 1.0 / 64.0  # of a step: of the differences
FASTER = 10.0  # than a step
ROUNDING = 1e-12  # of the coordinates
PLAIN, LEAST_SHARE = 1e-2, 1e-4  # of the gap there, and of all gaps: how far it leaves its line


def fast_gap(run: Any) -> str:
    """Which gap turns within a step of the run, in words; "" where no sample shows one."""
    n = len(run.t) - 1
    if n < 1:
        return ""
    looks = min(MOST, max(LEAST, run.counts.force_evaluations // PER))
    at = (np.arange(looks) + np.arange(looks) * GOLDEN % 1.0) / (looks + 1) * n
    k = at.astype(int)
    h = np.minimum(run.t[k + 1] - run.t[k], (run.t[-1] - run.t[0]) / max(1, run.counts.steps))
    with np.errstate(all="ignore"):
        _, curve = straight_on(run, k, h, (at - k)[:, None])
        most = np.nan_to_num(curve.max(axis=(1, 2)), posinf=0.0)
    which = np.argsort(most)[-CLOSER:]
    which = which[(most[which] > 0.0) & (h[which] > 0.0)]
    if not len(which):
        return ""
    k, h, share = k[which], h[which], (at - k)[which]
    places = np.column_stack([np.broadcast_to(AROUND, (len(k), len(AROUND))), share])
    with np.errstate(all="ignore"):
        g, curve = straight_on(run, k, h, places)
        start, end = g[:, None, 2], g[:, None, 3]
        left = np.abs(g - start - places[:, :, None] * (end - start))
        fast = curve[:, -1] / (8.0 * NEAR * NEAR) > FASTER * left.max(axis=1)
        fast &= left[:, -1] > PLAIN * np.minimum(np.abs(start), np.abs(end))[:, 0]
        fast &= left[:, -1] > LEAST_SHARE * np.nanmax(np.abs(g), axis=(0, 1))
    found = [
        (int(i), int(c)) for i, c in np.argwhere(fast) if left[i, -1, c] > rounding(run, int(k[i]), int(c))
    ]
    if not found:
        return ""
    i, c = found[0]
    time = run.t[k[i]] + share[i] * h[i]
    return (
        f"the gap of contact {c} turns within less than {h[i]:.3g} s at about t = {time:.6g} s, "
        f"as samples show, faster than the run has looked: take audit=True, which finds what was missed, or give the "
        f"times at which it turns as `corners`"
    )


def rounding(run: Any, k: int, c: int) -> float:
    """What rounding of the coordinates makes of gap c at a kept state."""
    G = normal(run.scene, c, (float(run.t[k]), run.q[k], run.v[k]))
    return ROUNDING * float(np.abs(G) @ np.abs(run.q[k]))


def straight_on(run: Any, k: Any, h: Array, places: Array) -> tuple[Array, Array]:
    """Gaps at so many steps h after the states k, and how much they bend there, (n, places, n_c) each."""
    moments = np.stack([places - NEAR, places, places + NEAR], axis=2) * h[:, None, None]
    times = np.clip((run.t[k, None, None] + moments).ravel(), run.t[0], run.t[-1])
    q = run.q[k, None, None] + moments[..., None] * run.v[k, None, None]
    g = gaps_at(model(run.scene), times, np.ascontiguousarray(q.reshape(len(times), -1)))
    cause()  # the motion may never come there: what a function raises does not count, but for the keyboard
    forget()
    g = g.reshape(*moments.shape, -1)
    return g[:, :, 1], np.abs(g[:, :, 0] - 2.0 * g[:, :, 1] + g[:, :, 2])
