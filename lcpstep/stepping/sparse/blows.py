"""Which contacts take part in the blows of a step, on whole vectors: all at once, or one blow after another.

The law and its reasons are those of `theta_method.blows`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.kernels.recurrence import looks_back
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.stepping.steps import LEFT, RETURNED, ROUNDING, TURNS

Array = NDArray[np.float64]


def opens_and_closes(u: Array, slow: float) -> bool:
    """Whether one of these gaps opens faster than `slow`, and another closes as fast."""
    return bool(np.any(u > slow) and np.any(u < -slow))


def forced(step: Any, u: Array, rate: Array, v: Array, v_free: Array, q: Array) -> Array:
    """How far the forces of a step move each gap velocity from u to `rate`, its rounding, and what moves nothing."""
    speed, unmoved = max(np.max(np.abs(v)), np.max(np.abs(v_free))), step.saddle.G_rows.sizes(q)
    return np.abs(rate - u) + ROUNDING * step.steepest * speed + RESOLUTION / step.h * unmoved


class Blows:
    """The blows of one step: `chosen` has the contacts of the next one, `last` is set where that is to be plastic.

    Parameters
    ----------
    active : (n_c,) of bool   contacts that may bear
    slow : speed beyond which they strike, or separate; negative where all take part at once
    restitution : (n_c,)
    """

    def __init__(self, active: Any, slow: float, restitution: Array) -> None:
        self.active, self.slow, self.several = active, slow, slow >= 0.0
        self.taken, self.fastest, self.last, self.chosen = 0, 0.0, False, active
        self.u_before, self.elastic = np.full(len(active), np.inf), bool(np.all(restitution[active] == 1.0))

    def follows(self, u: Array) -> bool:
        """Whether there is another blow, at these gap velocities."""
        self.taken += 1
        if not self.several:
            return self.taken == 1
        fastest = float(np.max(-u[self.active]))
        if self.last or fastest <= self.slow or self.taken > TURNS * np.count_nonzero(self.active):
            return False
        back = self.returns(u)
        if back and self.elastic:
            return False
        self.fastest = max(self.fastest, fastest)
        most = self.taken == TURNS * np.count_nonzero(self.active) and not self.elastic
        self.last = back or most or fastest <= LEFT * self.fastest
        self.chosen = self.active & (self.last | (u <= self.slow))
        return True

    def returns(self, u: Array) -> bool:
        """Whether the blows so far have come back to gap velocities of before."""
        if self.taken == 1:
            return False
        near = np.abs(u - self.u_before) <= RETURNED * self.fastest
        if looks_back(self.taken - 1):
            self.u_before = u.copy()
        return bool(np.all(near[self.active]))

    def rebound(self, u: Array, restitution: Array) -> Array:
        """What is added to the rates: by restitution, and of those at rest, which no blow may close faster."""
        if self.taken <= 1:
            return restitution * u
        if self.last:
            return np.zeros(len(u))
        return np.where((u > 0.0) | (u < -self.slow), restitution * u, -u)
