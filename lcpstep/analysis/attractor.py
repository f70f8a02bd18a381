"""What an attractor is, and a search for them has found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.lyapunov import Lyapunov

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Attractor:
    """One attractor.

    Attributes
    ----------
    periods : n of an O(n, m), 0 where the motion is aperiodic
    impacts : m, impacts in n periods; their mean per period where the motion is aperiodic
    landings : how often in n periods the contact closes for good, after complete chattering or an impact without
        rebound; in one period, on the average, where the motion is aperiodic. Of a system with modes: how often
        sliding begins
    points : (k, 2 n_q)   states (q, v), or (k, n_x), on the section: n of them, or many where the motion is aperiodic
    cloud : (j, 2 n_q)   the same, but many for every motion by time-stepping, whose grid scatters them; for an
        aperiodic one each period is taken with a step of its own, between 0.9 h and h, for on one grid all runs come
        to a cycle that only the grid has
    impact_phase, impact_before, impact_after : (m,)   impacts: phase in [0, 1), gap velocities [m/s]
    impact_number : (m,)   the number of each in its period, from 1
    impact_contact : (m,)   the contact that it is of
    lyapunov : largest Lyapunov exponent, per period of the forcing
    share : of the starts that went there
    modes : whether the scene is one with modes, so that `impacts` are its switches and landings begin to slide
    unsettled : why the motion has no name although it must be periodic in the end; empty for all others
    """

    periods: int
    impacts: float
    landings: float
    points: Array
    impact_phase: Array
    impact_before: Array
    impact_after: Array
    impact_number: NDArray[np.int64]
    impact_contact: NDArray[np.int64]
    cloud: Array
    lyapunov: Lyapunov
    share: float = 1.0
    modes: bool = False
    unsettled: str = ""

    @property
    def name(self) -> str:
        """O(n, m), O(n, chattering), chaotic, aperiodic where chaos is not certain, or unsettled."""
        if self.periods:
            endless = self.landings and not self.modes
            return f"O({self.periods}, {'chattering' if endless else round(self.impacts)})"
        if self.unsettled:
            return "unsettled"
        return "chaotic" if self.lyapunov.chaotic else "aperiodic"


@dataclass(frozen=True, eq=False)
class Attractors:
    """Attractors found from a number of starts.

    Attributes
    ----------
    found : the attractors, the one with the largest share first
    starts : (s, 2 n_q)   where the runs started
    label : (s,)   number of the attractor each run went to; -1 for runs that ended early, started inside, or
        grow without bound
    settings : what they were looked for with
    """

    found: tuple[Attractor, ...]
    starts: Array
    label: NDArray[np.int64]
    settings: dict[str, Any]
