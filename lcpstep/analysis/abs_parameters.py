"""The cycle of the hybrid anti-lock controller over its thresholds: where there is one, and which."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import replace as changed
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lagrangian.hybrid import HybridScene
from lcpstep.analysis.abs_cycle import (
    EXACT,
    LONGEST,
    corner,
    extremes,
    peak,
    returns,
)
from lcpstep.events.hybrid.many import Follower
from lcpstep.simulation import simulate

Array = NDArray[np.float64]
FINEST = 4.0 * np.finfo(float).eps  # relative, of a bisection


def with_thresholds(scene: HybridScene, **values: float) -> HybridScene:
    """The scene with other parameters, by name: torque_max, slip_min, ..."""
    names = [k for k, v in scene.parameters.items() if not isinstance(v, str)]
    p = np.array(scene.p)
    for name, value in values.items():
        p[names.index(name)] = value
    return changed(scene, p=p, parameters=dict(scene.parameters) | values)


def has_cycle(scene: HybridScene, longest: float = LONGEST) -> bool:
    """Whether the motion from (lambda_max, T_max) comes back to it within a time [s]."""
    start = corner(scene)
    return returns(Follower(scene, EXACT, longest, 4)(start, "2"), start)


def edge(exists: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """Where a property that holds at `inside` and not at `outside` is lost, by bisection to a width."""
    if not exists(inside) or exists(outside):
        raise ValueError(f"edge: expected the cycle at {inside:g} and none at {outside:g}")
    from scipy.optimize import bisect

    return float(bisect(lambda x: 1.0 if exists(x) else -1.0, inside, outside, xtol=0.5 * width, rtol=FINEST))


def vanishing(scene: HybridScene, width: float = 2e-10, longest: float = 1e7) -> float:
    """The largest torque threshold T_max [N m] below which the cycle has vanished.

    The time to pass the top of Psi grows as 1/sqrt(T_max - max Psi) as T_max comes down to it; `longest` [s] is
    waited for that.
    """
    top = peak(scene)[1]
    inside = float(scene.parameters["torque_max"])
    low = max(0.5 * (top + float(scene.parameters["torque_min"])), top - 10.0)
    return edge(lambda T: has_cycle(with_thresholds(scene, torque_max=T), longest), inside, low, width)


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """The cycle over the torque threshold: T_max (m,), period, smallest and largest slip; NaN where there is none."""

    torque_max: Array
    period: Array
    slip_low: Array
    slip_high: Array
    entered: Array  # (m, 4) slip at the four switches, from state 2 on

    def as_dict(self) -> dict[str, Any]:
        """The same for a file."""
        return {
            k: [None if v != v else v for v in x.tolist()] if x.ndim == 1 else x.tolist()
            for k, x in vars(self).items()
        }


def bifurcation(scene: HybridScene, torque_max: ArrayLike) -> Bifurcation:
    """Period and amplitude of the cycle for each torque threshold."""
    checks.instance("scene", scene, HybridScene)
    values = checks.vector("torque_max", torque_max)
    rows = []
    for T in values:
        other = with_thresholds(scene, torque_max=float(T))
        start = corner(other)
        end = Follower(other, EXACT, LONGEST, 4)(start, "2")
        if not returns(end, start):
            rows.append(np.full(7, np.nan))
            continue
        run = simulate(other.started(start, "2", (0.0, float(end.times[-1]))), EXACT)
        rows.append(
            np.array([end.times[-1], *extremes(run.at, float(end.times[-1])), start[0], *end.after[:3, 0]])
        )
    table = np.array(rows)
    return Bifurcation(np.array(values), table[:, 0], table[:, 1], table[:, 2], table[:, 3:])
