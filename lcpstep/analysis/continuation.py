"""Branches of periodic points over a parameter, through folds, by pseudo-arclength continuation.

    F(x, p) = P_p^n(x) - x = 0,      tau . (z - z_predicted) = 0,      z = (x, p)

On the way bifurcations are located as roots along the branch:

    fold   det(DP^n - 1) = 0, the branch turns back      (it goes straight on at a branch point)
    flip   det(DP^n + 1) = 0
    torus  a complex pair of multipliers crosses the unit circle
    jump   the multipliers jump across one of these: a border collision, where the map is not smooth (known to
           within a step only where the branch has a kink there)

Source: Yu. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), sections 10.2-10.3.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.branch import Branch, Special, Steps
from lcpstep.analysis.fixed_points import periodic_point
from lcpstep.analysis.predictor import Family, Follower, Monitor, Progress

Array = NDArray[np.float64]
__all__ = ["Branch", "Special", "Steps", "continue_point"]


def continue_point(
    family: Family,
    x: ArrayLike,
    p: float,
    p_range: tuple[float, float],
    *,
    n: int = 1,
    steps: Steps | None = None,
    monitor: Monitor | None = None,
    character: Callable[[float, Array], object] | None = None,
    forward: bool = True,
    progress: Progress | None = None,
) -> Branch:
    """Follow the periodic point near x at the parameter p as p changes.

    Parameters
    ----------
    family : p -> map
    x : (d,)   guess of the periodic point
    p, p_range : where to start, and the range that the branch must not leave
    n : period of the point
    steps : step control
    monitor : (p, x) -> named numbers whose sign changes are located and reported under their names
    character : (p, x) -> what points of one branch have in common; a step to a point that differs is refused
    forward : the direction of p in which the branch is followed first
    progress : called with parameter, point and multipliers of every point as it is found

    Returns
    -------
    Branch   whose last point lies on an end of the range, unless the branch or the number of points ends before, or
        it is closed: then its last point is its first; a KeyboardInterrupt ends it where it has come to

    Raises
    ------
    ValueError   the range is empty or reversed, or p lies outside of it
    NotConverged   no periodic point near x
    """
    checks.function("family", family, "the parameter that makes a map")
    low, high = (checks.number("p_range", end) for end in p_range)
    if not low < high:
        raise ValueError(f"p_range: expected low < high, got {p_range!r}")
    p = checks.number("p", p, least=low, most=high)
    start = periodic_point(family(p), x, n)
    follower = Follower(family, n, low, high, steps or Steps(), monitor, character, progress)
    return follower.branch(np.append(start.points[0], p), 1.0 if forward else -1.0)
