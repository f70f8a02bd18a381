"""Branches of periodic orbits over a parameter of their scene.

Along a branch the impacts that pass a corner of the forcing are located, and so is the grazing contact at which a
branch ends. Source: G. Osorio, Complex Behavior in Impacting Systems, sections 2.8.2, 3.3.2 and 4.4.2.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.continuation import Branch, Special, Steps, continue_point
from lcpstep.analysis.orbit import PeriodicOrbit as PeriodicOrbit
from lcpstep.analysis.orbit import described, quiet_phase
from lcpstep.analysis.orbit import moved as moved
from lcpstep.analysis.orbit import periodic_orbit as periodic_orbit
from lcpstep.analysis.predictor import PARAMETER_STEP, SPOILT, Progress
from lcpstep.analysis.variation import PeriodMap
from lcpstep.errors import LcpStepError
from lcpstep.maps.batch import Periods

Array = NDArray[np.float64]
REMEMBERED = 32  # maps and motions that are asked for again at once
GRAZING = 1e-2  # a branch that ends with a contact this soft, relative to the others, ends by grazing
AT_SECTION = 1e-3  # of the period: an impact this near to the section, where a branch ends, has reached it
CLEARLY = 3.0  # times as soft: the difference of two orbits that is no rounding


@dataclass(frozen=True, eq=False)
class OrbitBranch:
    """A branch of periodic orbits: the points of `points`, and the orbit at each.

    Attributes
    ----------
    points : Branch   parameter, states on the section, multipliers, special points
    phase : of the section
    orbits : the orbits, in the same order
    special : fold, flip, torus, branch point, jump; and "corner" (an impact at a corner of the forcing; the branch
        ends there where it meets another one) and "grazing" (where the branch ends by it)
    """

    points: Branch
    phase: float
    orbits: tuple[PeriodicOrbit, ...]
    special: tuple[Special, ...]


def continue_orbit(
    make: Callable[[float], Scene | HybridScene],
    orbit: PeriodicOrbit,
    p: float,
    p_range: tuple[float, float],
    *,
    steps: Steps | None = None,
    forward: bool = True,
    progress: Progress | None = None,
) -> OrbitBranch:
    """Follow a periodic orbit as a parameter of its scene changes, through folds, stable or not.

    Parameters
    ----------
    make : p -> scene
    orbit : where to start, from `periodic_orbit` at the parameter p
    p, p_range : parameter of the orbit, and the range that the branch must not leave
    steps, forward, progress : see `continue_point`

    Raises
    ------
    ValueError   the range is empty or reversed, or p lies outside of it
    NotConverged   the orbit is none of make(p)

    Notes
    -----
    The section is put where the orbit is farthest from its impacts. A branch whose impacts wander that far that one
    reaches the section ends there.
    """
    checks.function("make", make, "the parameter that makes a scene")
    checks.instance("orbit", orbit, PeriodicOrbit)
    start = moved(orbit, quiet_phase(orbit))
    n, method, phase = start.periods, start.method, start.phase

    @lru_cache(maxsize=REMEMBERED)
    def family(value: float) -> PeriodMap:
        return PeriodMap(make(value), method, phase)

    @lru_cache(maxsize=REMEMBERED)
    def followed(value: float, x: tuple[float, ...]) -> Periods:
        return family(value).follow(x, n)

    def monitor(value: float, x: Array) -> dict[str, float]:
        run, scene = followed(value, tuple(x)), family(value).scene
        times = run.time[0][np.isfinite(run.time[0])]
        if np.any(run.ends) or np.size(scene.corners) == 0:
            return {}
        distance = (times[:, None] - np.asarray(scene.corners)[None, :]) / scene.period
        distance = (distance + 0.5) % 1.0 - 0.5
        return {
            f"corner {len(times)} {i} {k}": float(d)
            for i, row in enumerate(distance)
            for k, d in enumerate(row)
        }

    def character(value: float, x: Array) -> int:
        run = followed(value, tuple(x))
        endless = np.any(run.ends) and isinstance(orbit.scene, Scene)
        return -1 if endless else int(np.sum(run.impacts))

    branch = continue_point(
        family,
        start.x[0],
        p,
        p_range,
        n=n,
        steps=steps,
        monitor=monitor,
        character=character,
        forward=forward,
        progress=progress,
    )
    orbits = tuple(
        described(family(float(value)), followed(float(value), tuple(x)).states[0][np.arange(n) - 1])
        for value, x in zip(branch.p, branch.x, strict=True)
    )
    special = [
        s._replace(kind=s.kind.split(" ")[0] if s.kind.startswith("corner") else s.kind)
        for s in branch.special
    ]
    # where a motion chatters its last impacts are soft everywhere, and no sign of a graze
    if branch.ended.startswith("no point") and isinstance(orbit.scene, Scene) and not orbits[-1].sticks:
        p_end, (value, x) = _grazing_parameter(orbits, branch.p), (float(branch.p[-1]), branch.x[-1])
        p_corner = _vanishing(_from_corner, orbits, branch.p)  # where it turns back in a kink
        # where an impact comes or goes beside the end, no differences tell the derivative by the parameter
        reach = SPOILT * PARAMETER_STEP * (p_range[1] - p_range[0])
        changes = {_impacts(followed, value + step, x) for step in (-reach, 0.0, reach)}
        if _grazes(orbits[-1]) or (0.0 < abs(p_end - value) <= 2.0 * reach and len(changes) > 1):
            special.append(Special("grazing", p_end, x, branch.multipliers[-1]))
        elif abs(p_corner - value) <= 2.0 * reach:
            special.append(Special("corner", p_corner, x, branch.multipliers[-1]))
        elif _from_section(orbits[-1]) < AT_SECTION:
            branch = replace(
                branch,
                ended=f"{branch.ended}: an impact reaches the section, start again from the last orbit",
            )
    return OrbitBranch(branch, phase, orbits, tuple(special))


def _from_section(orbit: PeriodicOrbit) -> float:
    """Share of the period from the section to the impact nearest to it; infinite where there is none."""
    away = np.abs((orbit.phases - orbit.phase + 0.5) % 1.0 - 0.5)
    return float(np.min(away, initial=np.inf))


def _from_corner(orbit: PeriodicOrbit) -> float:
    """Share of the period from a corner of the forcing to the impact nearest to one; infinite where there is none."""
    return float(np.min(np.abs(orbit.corner_distances()), initial=np.inf))


def _impacts(
    followed: Callable[[float, tuple[float, ...]], Periods], p: float, x: Array
) -> tuple[int, ...] | None:
    """Number of impacts in each period of the motion through x; None of one that does not begin or ends early."""
    try:
        return tuple(followed(p, tuple(x)).impacts[0].tolist())
    except (ValueError, LcpStepError):
        return None


def _grazing_parameter(orbits: tuple[PeriodicOrbit, ...], p: Array) -> float:
    """Where the contact becomes as soft as can be: the clearance, or the lowest speed, is zero; p[-1] where unknown.

    Either is linear in the parameter there, a speed because the orbit yields by as much as a graze moves it.
    """
    ways = [_lowest_speed] if _soft(orbits[-1]) else [_lowest_speed, PeriodicOrbit.clearance]
    ends = [end for softness in ways if np.isfinite(end := _vanishing(softness, orbits, p))]
    return min(ends, key=lambda end: abs(end - p[-1]), default=float(p[-1]))


def _vanishing(
    softness: Callable[[PeriodicOrbit], float], orbits: tuple[PeriodicOrbit, ...], p: Array
) -> float:
    """Where this is zero, from the last orbits that clearly differ in it; nan where they do not.

    The very last is left out if it can be: of the softest contact the speed is the square root of its rounding.
    """
    alike = [k for k in range(len(orbits)) if len(orbits[k].time) == len(orbits[-1].time)]
    found: list[tuple[float, float]] = []
    for k in reversed(alike):
        value = softness(orbits[k])
        if not np.isfinite(value):
            break
        if not found or value >= CLEARLY * found[-1][1]:
            found.append((float(p[k]), value))
        if len(found) == 3:
            break
    if len(found) < 2:
        return np.nan
    (p_first, first), (p_last, last) = found[-1], found[-2]
    return p_last + last * (p_last - p_first) / (first - last)


def _lowest_speed(orbit: PeriodicOrbit) -> float:
    """Of all its impacts [m/s]; infinite where it has none."""
    return float(np.min(np.abs(orbit.before), initial=np.inf))


def _soft(orbit: PeriodicOrbit) -> bool:
    """Whether one impact is much softer than the others."""
    speeds = np.abs(orbit.before)
    hardest = float(np.max(speeds, initial=0.0))
    if len(speeds) == 1:  # against the speed of the motion itself
        hardest = float(np.max(np.abs(orbit.x[:, orbit.scene.n_x // 2 :])))
    return len(speeds) > 0 and float(np.min(speeds)) < GRAZING * hardest


def _grazes(orbit: PeriodicOrbit) -> bool:
    """Whether one contact of the orbit is much softer than the others, or is about to appear."""
    height = float(np.ptp(orbit.x[:, 0])) + abs(float(orbit.x[0, 0]))
    return _soft(orbit) or orbit.clearance() < GRAZING**2 * max(height, 1e-300)
