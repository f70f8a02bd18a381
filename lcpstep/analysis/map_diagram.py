"""Diagrams, exponents and periodic points of maps given by formulas (`lcpstep.maps.formulas`).

The record at each value of the parameter starts from a fixed point of the plane, or from where the neighbour's ended.
An orbit that leaves all bounds has none. The exponent is that of the recorded part.
"""

from __future__ import annotations

import importlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lcpstep.analysis.fixed_points import (
    NotConverged,
    PeriodicPoint,
    image_and_derivative,
    multipliers,
    periodic_point,
)
from lcpstep.analysis.lyapunov import Lyapunov, lyapunov
from lcpstep.dataset import Progress, check_free, labelled
from lcpstep.errors import LcpStepError, UnknownName
from lcpstep.maps.formulas import Family
from lcpstep.maps.iteration import Map
from lcpstep.sweep import Arrays, sweep

Array = NDArray[np.float64]
BOUND = 1e6  # of an orbit that has not escaped, in units of 1 + |x0|
PART = 16  # values of a part of the sweep
SAME = 1e-7  # distance of two periodic points that are one, relative to the size of their orbits
TAKEN = {"x", "lyapunov", "lyapunov_error", "iteration", "state"}  # names in the dataset
STARTS = ("fixed", "forward", "backward")


class Escaped(LcpStepError):
    """An orbit that has left all bounds."""


def settled(P: Map, x: ArrayLike, drop: int, keep: int) -> Array:
    """The orbit of x after `drop` iterations, (keep, d); Escaped where it leaves all bounds."""
    x = np.array(checks.vector("x", x))
    size, points = BOUND * (1.0 + float(np.max(np.abs(x)))), []
    for k in range(drop + keep):
        try:
            x = np.atleast_1d(np.asarray(P(x), dtype=float))
        except LcpStepError as error:
            raise Escaped(f"the orbit ended after {k} iterations: {error}") from error
        if not np.max(np.abs(x)) <= size:
            raise Escaped(f"the orbit left all bounds after {k + 1} iterations, at x = {x.tolist()}")
        if k >= drop:
            points.append(x)
    return np.array(points)


def exponent(P: Map, x: ArrayLike, n: int, period: int = 0) -> Lyapunov:
    """Largest Lyapunov exponent along n iterations from x; not known where a derivative does not exist.

    period : after which x comes back, so that the exponent is that of the multipliers; 0 where it does not
    """
    try:
        if period:
            largest = float(abs(multipliers(image_and_derivative(P, np.asarray(x), period)[1])[0]))
            return Lyapunov(math.log(largest) / period if largest > 0.0 else -math.inf, 0.0)
        return lyapunov(P, x, n)
    except (LcpStepError, ValueError):
        return Lyapunov(math.nan, math.nan)


def periodic_points(
    P: Map, box: ArrayLike, n: int = 1, *, starts: int = 200, seed: int = 0
) -> list[PeriodicPoint]:
    """Points of least period n, stable or not, that Newton's method finds from random points of a box (2, d).

    There may be more. Of every orbit one point is given.
    """
    box = np.asarray(box, dtype=float)
    found: list[PeriodicPoint] = []
    for x in np.random.default_rng(seed).uniform(
        box[0], box[1], (checks.count("starts", starts), box.shape[1])
    ):
        try:
            point = periodic_point(P, x, n)
        except (NotConverged, LcpStepError, ValueError, ArithmeticError):
            continue
        size = SAME * max(float(np.max(np.abs(point.points))), float(np.max(np.abs(box))))
        less = any(n % k == 0 and _near(point.points[0], point.points[k], size) for k in range(1, n))
        if not less and not any(_near(point.points[0], y, size) for other in found for y in other.points):
            found.append(point)
    return sorted(found, key=lambda point: float(point.points[0, 0]))


def _near(x: Array, y: Array, size: float) -> bool:
    return float(np.max(np.abs(x - y))) <= size


def map_diagram(
    family: Family,
    parameter: str,
    values: ArrayLike,
    *,
    x0: ArrayLike | None = None,
    start: str = "fixed",
    drop: int = 500,
    keep: int = 200,
    jobs: int | None = None,
    out: Path | str | None = None,
    progress: Progress | None = None,
) -> Any:
    """Brute-force bifurcation diagram of a family of maps, with its exponents.

    Parameters
    ----------
    family : of `lcpstep.maps.formulas`
    parameter, values : name and increasing values (n,) of the parameter
    x0 : (d,)   where orbits start; the family's own where not given
    start : "fixed": each from x0; "forward", "backward": each from where its neighbour ended
    drop, keep : iterations of the transient and of the record
    jobs, out, progress : see `lcpstep.sweep.sweep`

    Returns
    -------
    xarray.Dataset   x on (<parameter>, iteration, state), nan where the orbit left all bounds; lyapunov and
        lyapunov_error on (<parameter>)

    Raises
    ------
    UnknownName   the family has no such parameter
    ValueError   values not increasing or outside of the parameter's range, an unknown kind of start
    """
    checks.instance("family", family, Family)
    if parameter not in family.parameters:
        raise UnknownName(f"parameter of {family.name}", parameter, family.parameters)
    check_free(parameter, TAKEN)
    values = checks.increasing(parameter, values)
    if start not in STARTS:
        raise ValueError(f"start: expected one of {', '.join(STARTS)}, got {start!r}")
    for end in (values[0], values[-1]):
        family.at(**{parameter: float(end)})
    x = checks.array("x0", family.x0 if x0 is None else x0, np.shape(family.x0))
    study = _Study(
        family,
        parameter,
        values,
        x,
        start,
        int(checks.number("drop", drop, least=0)),
        checks.count("keep", keep),
    )
    order = list(range(len(values)))[:: -1 if start == "backward" else 1]
    parts = [order[i : i + PART] for i in range(0, len(order), PART)]
    chains: Sequence[Sequence[Any]] = [[part] for part in parts] if start == "fixed" else [parts]
    done = sweep(study, chains, study.inputs(), out=out, jobs=jobs, progress=progress)
    rows = [part for chain in done for part in chain]
    sort = np.argsort(np.concatenate([row["index"] for row in rows]))
    table = {name: np.concatenate([row[name] for row in rows])[sort] for name in ("x", "lyapunov", "error")}
    return labelled(
        {
            "x": ((parameter, "iteration", "state"), table["x"]),
            "lyapunov": ((parameter,), table["lyapunov"]),
            "lyapunov_error": ((parameter,), table["error"]),
        },
        {parameter: values},
        {k: v for k, v in study.inputs().items() if k != "values"},
    )


@dataclass(frozen=True, eq=False)
class _Study:
    """What every part of the sweep knows."""

    family: Family
    parameter: str
    values: Array
    x0: Array
    start: str
    drop: int
    keep: int

    def __call__(self, part: list[int], handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
        x = self.x0 if handed is None else handed["x"]
        points, growth = np.full((len(part), self.keep, len(x)), math.nan), np.full((len(part), 2), math.nan)
        for row, i in enumerate(part):
            P = self.family.at(**{self.parameter: float(self.values[i])})
            try:
                points[row] = settled(P, x, self.drop, self.keep)
            except Escaped:
                x = self.x0
                continue
            found = exponent(P, points[row, 0], self.keep)
            growth[row] = found.largest, found.error
            x = self.x0 if self.start == "fixed" else points[row, -1]
        arrays: Arrays = {
            "x": points,
            "lyapunov": growth[:, 0],
            "error": growth[:, 1],
            "index": np.array(part),
        }
        return arrays, {"x": x}

    def inputs(self) -> dict[str, Any]:
        """What the result depends on."""
        return {
            "map": self.family.name, "parameter": self.parameter, "values": self.values.tolist(),
            "parameters": [f"{k} = {x!r}" for k, x in self.family.parameters.items() if k != self.parameter],
            "x0": self.x0.tolist(), "start": self.start, "drop": self.drop, "keep": self.keep,
            "source": self.family.source,
            "lcpstep": importlib.import_module("lcpstep").__version__,
        }  # fmt: skip
