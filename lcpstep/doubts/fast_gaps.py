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

from lcpstep.callbacks.faults import cause, forget
from lcpstep.kernels.fast_turn import first_turn
from lcpstep.model import looked_at
from lcpstep.turns.source import GOLDEN

PER, LEAST, MOST = 8, 32, 2048  # evaluations of the forces per look, and how many looks there are


def fast_gap(run: Any) -> str:
    """Which gap turns within a step of the run, in words; "" where no sample shows one."""
    n = len(run.t) - 1
    if n < 1:
        return ""
    looks, steps = min(MOST, max(LEAST, run.counts.force_evaluations // PER)), max(1, run.counts.steps)
    i, c = first_turn(looked_at(run.scene), run.t, run.q, run.v, steps, looks, GOLDEN)
    cause()  # the motion may never come there: what a function raises does not count, but for the keyboard
    forget()
    if i < 0:
        return ""
    at = (i + i * GOLDEN % 1.0) / (looks + 1) * n
    k = int(at)
    h = min(run.t[k + 1] - run.t[k], (run.t[-1] - run.t[0]) / steps)
    return (
        f"the gap of contact {c} turns within less than {h:.3g} s at about t = {run.t[k] + (at - k) * h:.6g} s, "
        f"as samples show, faster than the run has looked: take audit=True, which finds what was missed, or give the "
        f"times at which it turns as `corners`"
    )
