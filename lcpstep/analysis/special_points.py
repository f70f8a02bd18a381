"""Special points between two points of a branch: roots of its test functions, and what is there.

Where a branch crosses another (a symmetric orbit that loses its symmetry) the equations are singular, and it can be
followed to either side of the crossing only: the root is told from there. Where it cannot be followed to a change of
sign at all, the map is not smooth.

Source: Yu. Kuznetsov, Elements of Applied Bifurcation Theory (Springer 2004), section 10.3.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.branch import Special, State
from lcpstep.analysis.fixed_points import multipliers
from lcpstep.errors import LcpStepError

if TYPE_CHECKING:
    from lcpstep.analysis.predictor import Follower

Array = NDArray[np.float64]
ROOT = 1e-13  # of a step, where a bifurcation is located
BESIDE = 0.1  # shares of a step, as far from a crossing as the branch can be followed for certain
AGREE = 0.05  # the same: how far apart the roots are that are told from either side of it
KINDS = ("fold", "branch point", "flip", "torus", "jump")
SMALL = 1e-4  # a test function this small at its sign change, relative to the ends, is zero there and no jump


def between(follower: Follower, state: State, end: State, tangent: Array, ds: float) -> list[Special]:
    """Special points within a step of length ds along the tangent, in their order."""
    found: list[tuple[float, Special]] = []
    for name, value in state.tests.items():
        other = end.tests.get(name)
        if other is not None and value * other < 0.0:
            place = _located(follower, state, end, tangent, ds, name)
            found += [] if place is None else [place]
    watched = [special for _, special in found if special.kind not in KINDS]
    # Where the branch has a kink it cannot be followed to the jump itself; but what makes it jump is located
    found = [
        (s, x._replace(p=watched[0].p, x=watched[0].x))
        if x.kind == "jump" and s == 1.0 and watched
        else (s, x)
        for s, x in found
    ]
    return [special for _, special in sorted(found, key=lambda pair: pair[0])]


def _located(
    follower: Follower, state: State, end: State, tangent: Array, ds: float, name: str
) -> tuple[float, Special] | None:
    """Where one test function changes its sign, as a share of the step, and what is there; None for nothing."""
    from scipy.optimize import brentq

    at: dict[float, State] = {0.0: state, 1.0: end}

    def test(s: float) -> float:
        if s not in at:
            point = follower.step(state, tangent, s * ds)
            if point is None or name not in point[0].tests:
                raise LcpStepError("lost")
            at[s] = point[0]
        return at[s].tests[name]

    try:
        s = brentq(test, 0.0, 1.0, xtol=ROOT, rtol=1e-15)
    except LcpStepError:
        s = math.nan if name.startswith(" ") else _around_root(test, at, name)
        if math.isnan(s):  # the branch has a kink in between, sharper than the hyperplane can follow
            return None if name.startswith(" ") else (1.0, _special("jump", end))
    jumps = abs(test(s)) > SMALL * max(abs(state.tests[name]), abs(end.tests[name]))
    if jumps and name.startswith(" "):  # a monitored number that jumps does not pass zero
        return None
    kind = "jump" if jumps else name.strip()
    if kind == "fold" and follower.tangent(state, tangent)[-1] * follower.tangent(end, tangent)[-1] > 0.0:
        kind = "branch point"
    return s, _special(kind, at[s])


def _around_root(test: Callable[[float], float], at: dict[float, State], name: str) -> float:
    """Where a test function vanishes at which the branch is lost, for it crosses another there; nan for nowhere.

    From points well on either side of it: nearer ones may be of the other branch. The state there, by the polynomials
    through those of all these points, is added to `at`.
    """
    from scipy.optimize import brentq

    a, b = at[0.0].tests[name], at[1.0].tests[name]
    middle = a / (a - b)
    places = [middle + k * BESIDE for k in (-2.0, -1.0, 1.0, 2.0)]  # they may lie beyond the step's ends
    try:
        values = {0.0: a, 1.0: b, **{s: test(s) for s in places}}
    except LcpStepError:
        return math.nan
    known = np.array(sorted(values))
    left, right = known[known < middle][-2:], known[known > middle][:2]
    roots = [
        s - values[s] * (s - r) / (values[s] - values[r])
        for s, r in ((left[1], left[0]), (right[0], right[1]))
    ]
    if not abs(roots[0] - roots[1]) <= AGREE or not values[left[1]] * values[right[0]] < 0.0:
        return math.nan

    def between_them(s: float, of: Callable[[State], Any]) -> Any:
        columns = np.linalg.solve(np.vander(known - middle), np.array([np.ravel(of(at[k])) for k in known]))
        return np.polyval(columns, s - middle).reshape(np.shape(of(at[0.0])))

    s = float(brentq(lambda s: float(between_them(s, lambda x: x.tests[name])), left[1], right[0], xtol=ROOT))
    at[s] = State(between_them(s, lambda x: x.z), between_them(s, lambda x: x.J), at[0.0].slope, {name: 0.0})
    return s


def _special(kind: str, at: State) -> Special:
    return Special(kind, float(at.z[-1]), at.z[:-1], multipliers(at.J))
