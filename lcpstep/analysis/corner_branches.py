"""Periodic orbits on both sides of a corner impact, of the local map and of the full system, stable or not.

The local map has one fixed point for impacts before the corner and one for impacts after it, x = (1 - A)^-1 B dp,
each on its own side of the border for one sign of dp. The orbits of the full system are found from these by
Newton's method. Source: G. Osorio, Complex Behavior in Impacting Systems, section 5.4, Fig 5.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify
from lcpstep.analysis.corners import NARROW, WIDE, CornerImpact, local_map
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.errors import LcpStepError
from lcpstep.pace import counted

Array = NDArray[np.float64]
ROUNDING = 64 * np.finfo(float).eps


@dataclass(frozen=True, eq=False)
class FixedBranch:
    """Fixed points over the parameter; of the local map where `local`, of the full system elsewhere.

    p : (k,) parameters;  x : (k, d) states on the section;  stable : of all of them
    """

    p: Array
    x: Array
    stable: bool
    local: bool

    def as_dict(self) -> dict[str, Any]:
        """The same for a file."""
        return {"p": self.p.tolist(), "x": self.x.tolist(), "stable": self.stable, "local": self.local}


def orbit_branches(orbit: CornerImpact, chain: PiecewiseLinearMap, values: Array) -> list[FixedBranch]:
    """The branches that meet at the corner impact, for the given parameters."""
    found = classify(chain)
    result = []
    for slope, exists, multipliers in (
        (found.fixed.minus, found.fixed.minus_exists, found.multipliers_minus),
        (found.fixed.plus, found.fixed.plus_exists, found.multipliers_plus),
    ):
        stable = bool(np.max(np.abs(multipliers)) < 1.0)
        for sign, there in zip((-1.0, 1.0), exists, strict=True):
            p = values[sign * (values - orbit.p) > 0.0]
            if not there or len(p) == 0:
                continue
            p = np.sort(np.append(p, orbit.p))
            x = orbit.x + np.outer(p - orbit.p, slope)
            result.append(FixedBranch(p, x, stable, True))
            result += _of_the_system(orbit, p, slope, stable)
    return result


def _of_the_system(orbit: CornerImpact, p: Array, slope: Array, stable: bool) -> list[FixedBranch]:
    """Orbits of the full system from those of the local map, each from the one before; up to where they are lost."""
    order = np.argsort(np.abs(p - orbit.p), kind="stable")
    kept, states = [orbit.p], [orbit.x]
    for k in counted(order[1:].tolist()):
        step = float(p[k] - kept[-1])
        ahead = slope if len(kept) < 3 else (states[-1] - states[-2]) / (kept[-1] - kept[-2])
        try:
            found = periodic_orbit(
                orbit.make(float(p[k])), states[-1] + step * ahead, orbit.periods, phase=orbit.phase
            )
        except (LcpStepError, ValueError):
            break
        if found.stable != stable or found.sticks:
            break
        kept.append(float(p[k]))
        states.append(found.x[0])
    if len(kept) < 2:
        return []
    at = np.argsort(kept)
    return [FixedBranch(np.array(kept)[at], np.array(states)[at], stable, False)]


def uncertainty(orbit: CornerImpact, chain: PiecewiseLinearMap) -> dict[str, float]:
    """By how much each part of the local map may be off: what half the step of differences changes, or rounding."""
    other = local_map(orbit, step=0.5 * (NARROW if len(orbit.others) else WIDE))
    result = {}
    for name in ("A_minus", "A_plus", "B_minus", "B_plus", "C", "D"):
        one, two = np.asarray(getattr(chain, name)), np.asarray(getattr(other, name))
        result[name] = max(float(np.max(np.abs(one - two))), ROUNDING * float(np.max(np.abs(one))))
    return result
