"""How far two bifurcation diagrams are apart, value by value of the parameter, and over the whole window.

A column of a diagram is a cloud of points. Two columns are compared by the 1-Wasserstein distance of their
distributions, on the line and, for phases of impacts, on the circle:

    W = integral of |F(x) - H(x)| dx,      W = min over c of the integral of |F(x) - H(x) - c| dx

Between two periodic motions of as many points it is the mean distance of matched points, between chaotic ones a
distance of their distributions. It does not see in what order the points are visited, weighs a rare branch by how
rarely it is visited, and knows no more impacts of a period than the diagrams have recorded. Two samples of one
chaotic motion are not at distance zero: the floor says how far the two halves of the reference are apart.
Source: J. Rabin, J. Delon, Y. Gousseau, Transportation distances on the circle, J. Math. Imaging Vis. 41 (2011).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.listed import column
from lcpstep.analysis.returns import TOLERANCE, return_time
from lcpstep.dataset import labelled
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
CLOUD, WIDEST = 100.0, 0.25
SETTINGS = ("parameter", "scene", "start", "drop", "keep", "phase")  # that two diagrams must share


class Summary(NamedTuple):
    """One row for a window: medians over the parameter, and the share of values with the same motion."""

    phase: float
    state: float
    phase_floor: float
    state_floor: float
    same: float


def agreement(data: Any, reference: Any, tolerance: ArrayLike = TOLERANCE) -> Any:
    """Distance of two bifurcation diagrams at every value of the parameter.

    Parameters
    ----------
    data, reference : datasets of `lcpstep.analysis.bifurcation.bifurcation` for the same values and settings, by
        two methods for example
    tolerance : of a return in `data`, relative to the size of the motion, one number or one for each value; see
        `tolerance_of_stepping`

    Returns
    -------
    xarray.Dataset   on <parameter>: phase_distance of the impacts [periods], infinite where only one of the two
        has any; state_distance on the section, the largest over the coordinates q and v, each in units of its
        largest value in the reference; phase_floor, state_floor, the same between the two halves of the
        reference; name, name_reference, O(n, m) or aperiodic; same, whether these two agree. A value at which a run
        of either ended early is nan, and not the same.

    Raises
    ------
    ValueError   the diagrams are of different scenes, values or settings, or a tolerance is not positive
    """
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.bifurcation")
    checks.has("reference", reference, "attrs", "a dataset of lcpstep.analysis.bifurcation")
    parameter = str(reference.attrs["parameter"])
    for key in SETTINGS:
        if data.attrs.get(key) != reference.attrs.get(key):
            raise ValueError(f"data: expected {key} = {reference.attrs.get(key)}, got {data.attrs.get(key)}")
    values = reference[parameter].values
    if not np.array_equal(data[parameter].values, values):
        raise ValueError(f"data: expected the values of {parameter} of the reference")
    allowed = np.broadcast_to(np.asarray(tolerance, dtype=float), values.shape)
    for x in allowed:
        checks.positive("tolerance", x)
    size = np.max(np.abs(_states(reference)), axis=(0, 1, 2), initial=1e-300)
    rows = [_compared(data, reference, k, float(allowed[k]), size) for k in range(len(values))]
    columns = {name: ((parameter,), np.array([row[name] for row in rows])) for name in rows[0]}
    attributes = {"method": data.attrs["method"], "reference": reference.attrs["method"]}
    return labelled(columns, {parameter: values}, dict(reference.attrs) | attributes)


def tolerance_of_stepping(h: float, period: ArrayLike) -> Array:
    """Within which a periodic motion by time-stepping returns: its points are clouds of the size of h.

    On the cam-follower at 690-735 rpm they are up to 53 h / period wide. Beyond a quarter of its size nothing is
    taken for a return.
    """
    return np.asarray(np.minimum(CLOUD * h / np.asarray(period, dtype=float), WIDEST))


def summary(apart: Any) -> Summary:
    """One row for the whole window."""

    def median(name: str) -> float:
        return float(np.nanmedian(apart[name].values))

    return Summary(
        phase=median("phase_distance"), state=median("state_distance"), phase_floor=median("phase_floor"),
        state_floor=median("state_floor"), same=float(np.mean(apart["same"].values)),
    )  # fmt: skip


def circle_distance(a: Array, b: Array) -> float:
    """1-Wasserstein distance of two samples on the circle [0, 1); infinite where one of the two is empty."""
    if len(a) == 0 or len(b) == 0:
        return 0.0 if len(a) == len(b) else float("inf")
    x = np.concatenate([a, b])
    order = np.argsort(x, kind="stable")
    weight = np.concatenate([np.full(len(a), 1.0 / len(a)), np.full(len(b), -1.0 / len(b))])
    x, step = x[order], np.cumsum(weight[order])  # the difference of the distribution functions after each
    length = np.diff(x, append=x[0] + 1.0)
    order = np.argsort(step, kind="stable")
    half = int(np.searchsorted(np.cumsum(length[order]), 0.5))
    median = step[order[min(half, len(step) - 1)]]
    return float(np.sum(np.abs(step - median) * length))


def _states(data: Any) -> Array:
    """(run, value, period, 2 n_q)."""
    return np.concatenate([data["q"].values, data["v"].values], axis=-1)


def _compared(data: Any, reference: Any, k: int, tolerance: float, size: Array) -> dict[str, Any]:
    """The k-th column of two diagrams."""
    own, other = (_states(d)[:, k] for d in (data, reference))
    (phases, _), (others, when) = (column(d, "impact_phase", k) for d in (data, reference))
    half = other.shape[1] // 2
    names = _names(data, k, tolerance), _names(reference, k, TOLERANCE)
    ended = any(np.any(d["status"].values[:, k] != Status.DONE) for d in (data, reference))
    return {
        "phase_distance": np.nan if ended else circle_distance(phases, others),
        "state_distance": np.nan if ended else _apart(own, other, size),
        "phase_floor": np.nan if ended else circle_distance(others[when < half], others[when >= half]),
        "state_floor": np.nan if ended else _apart(other[:, :half], other[:, half:], size),
        "name": names[0], "name_reference": names[1], "same": not ended and names[0] == names[1],
    }  # fmt: skip


def _apart(a: Array, b: Array, size: Array) -> float:
    """States of all runs; the largest distance over the coordinates."""
    from scipy.stats import wasserstein_distance

    return max(wasserstein_distance(a[..., i].ravel(), b[..., i].ravel()) / size[i] for i in range(len(size)))


def _names(data: Any, k: int, tolerance: float) -> str:
    """What the runs at the k-th value have settled to, each motion once."""
    found = set()
    for states, impacts, ends in zip(
        _states(data)[:, k], data["impacts"].values[:, k], data["ends"].values[:, k], strict=True
    ):
        size = max(float(np.max(np.abs(states))), 1e-300)
        n = return_time(states, len(states) // 2, tolerance * size)
        m = "chattering" if np.any(ends[-n:]) else int(np.sum(impacts[-n:]))
        found.add(f"O({n}, {m})" if n else "aperiodic")
    return " + ".join(sorted(found))
