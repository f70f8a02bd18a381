"""Impacts without end at one instant, as kernels: a body between two walls without clearance, or in their corner.

The laws of impact are homogeneous: where the speeds of the contacts struck return in proportion, u -> rho u, they do
so for ever. With rho < 1 the impacts that are left sum to rho / (1 - rho) of those of the last turn, and leave no
speed; with rho = 1 they have no end. The turn is looked for by comparison with the speeds at powers of two. Source of
the search: R. Brent, An improved Monte Carlo factorization algorithm, BIT 20 (1980), section 2.
"""

from __future__ import annotations

from typing import Any

from lcpstep.events.bookkeeping import ACCUMULATION
from lcpstep.events.clock import T0
from lcpstep.events.several.chatter import stop
from lcpstep.events.several.impact import apply, speed_noise
from lcpstep.events.several.keep import log
from lcpstep.events.several.state import (
    CLOSED,
    CYCLE_IMPULSE,
    CYCLE_SPEED,
    HELD_ROWS,
    JOINT_CYCLE_IMPULSE,
    SINCE,
    SPEED,
    STRUCK,
)

RETURNS = 2.0**-40  # relative deviation from proportion
FOR_EVER = 1.0 - 2.0**-30  # of rho: nothing is lost


def look_back(s: Any) -> None:
    """Compare with the speeds of now from now on."""
    for c in range(len(s.G)):
        s.contact[CYCLE_SPEED, c], s.contact[CYCLE_IMPULSE, c] = s.contact[SPEED, c], 0.0
    for i in range(len(s.J)):
        s.joint[JOINT_CYCLE_IMPULSE, i] = 0.0


def recurrence(s: Any) -> float:
    """The ratio rho in which the speeds of all contacts struck since have returned, or 0 if they have not."""
    most, ratio = 0.0, 0.0
    for c in range(len(s.G)):
        if s.contact[CYCLE_IMPULSE, c] > 0.0 and abs(s.contact[CYCLE_SPEED, c]) > most:
            most = abs(s.contact[CYCLE_SPEED, c])
            ratio = s.contact[SPEED, c] / s.contact[CYCLE_SPEED, c]
    if ratio > 0.0:
        for c in range(len(s.G)):
            if s.contact[CYCLE_IMPULSE, c] > 0.0:
                error = abs(s.contact[SPEED, c] - ratio * s.contact[CYCLE_SPEED, c])
                if error > RETURNS * ratio * most + speed_noise(s, c):
                    return 0.0
    return max(ratio, 0.0)


def sum_up(s: Any, record: Any, count: Any, ratio: float) -> None:
    """Take the impacts that are left as one: the contacts that they strike are closed."""
    n_j, n_c, rest = len(s.J), len(s.G), ratio / (1.0 - ratio)
    s.number[HELD_ROWS] = n_j + n_c
    for i in range(n_j + n_c):
        turn = s.joint[JOINT_CYCLE_IMPULSE, i] if i < n_j else s.contact[CYCLE_IMPULSE, i - n_j]
        s.row[i], s.change[i] = i, rest * turn
    before = s.x[T0]
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            log(s, record, count, before, c, float(ACCUMULATION), s.contact[SPEED, c], 0.0, s.change[n_j + c])
    apply(s)
    for c in range(n_c):
        if s.change[n_j + c] > 0.0:
            s.mode[CLOSED, c] = 1
            s.contact[SINCE, c], s.contact[STRUCK, c] = before - s.contact[STRUCK, c], before
    stop(s)
