"""Brute-force bifurcation diagrams: simulate at every parameter value, drop the transient, record the rest.

The motion at each value starts from a fixed state, from where the one before ended (forward or backward, which
shows hysteresis), or from random states (Monte Carlo, which shows coexisting attractors). Both sections are
recorded: the state once per period, and phase and velocities of all impacts, of chattering sequences too, with the
accumulation points where these end. Source: G. Osorio, Complex Behavior in Impacting Systems, section 3.3.1 and
chapter 4 (zero relative position and velocity, 60 periods).
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.analysis.listed import joined, listed
from lcpstep.dataset import Progress, check_free, labelled, provenance, units
from lcpstep.described import checksum, checksum_of
from lcpstep.events import EventDriven
from lcpstep.maps.batch import INSIDE, periods, section
from lcpstep.simulation import Method
from lcpstep.sweep import Arrays, sweep
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
Start = Literal["fixed", "forward", "backward", "random"]
STARTS = ("fixed", "forward", "backward", "random")
IMPACTS_RECORDED = 512  # of a period
PART = 8  # parameter values of a part of the sweep
LISTS = {  # of all events, and what each says of one
    "impact": ("value", "run", "period", "number", "contact", "phase", "before", "after"),
    "landing": ("value", "run", "period", "number", "contact", "phase"),
}
TAKEN = {  # names in the dataset
    "run", "period", "impacts", "ends", "status", "corner_phase", "corner", *LISTS,
    *(f"{kind}_{name}" for kind, names in LISTS.items() for name in names),
}  # fmt: skip
OF_STATES = {HybridScene: {"x", "state"}, Scene: {"q", "v", "coordinate"}}
WINDOWS = {  # rpm of the cam-follower, as in the thesis
    "114-850": (114.0, 850.0),
    "114-200": (114.0, 200.0),
    "198-200": (198.0, 200.0),
    "357.5-361.5": (357.5, 361.5),
    "660-670": (660.0, 670.0),
    "660-760": (660.0, 760.0),
    "690-735": (690.0, 735.0),
}


def bifurcation(
    make: Callable[..., Scene | HybridScene],
    parameter: str,
    values: ArrayLike,
    *,
    method: Method | None = None,
    start: Start = "fixed",
    x0: ArrayLike | None = None,
    box: ArrayLike | None = None,
    runs: int = 1,
    seed: int = 0,
    drop: int = 500,
    keep: int = 60,
    phase: float = 0.0,
    most: int = IMPACTS_RECORDED,
    executor: Executor | None = None,
    jobs: int | None = None,
    out: Path | str | None = None,
    progress: Progress | None = None,
) -> Any:
    """Brute-force bifurcation diagram of a family of scenes.

    Parameters
    ----------
    make : make(**{parameter: value}) -> scene or scene with modes, for example `lagrangian.scenes.cam_follower`
    parameter, values : name and increasing values (n,) of the parameter
    method : EventDriven() where not given
    start : "fixed": every run from x0; "forward", "backward": the first from x0, each further one from where its
        neighbour ended; "random": `runs` runs a value from states drawn uniformly from `box`
    x0 : (2 n_q,)   state (q, v), or (n_x,), at the section; zero where not given
    box : (2, 2 n_q)   lowest and highest states of the random starts
    runs, seed : number of random starts at each value, and the seed that they are drawn with
    drop, keep : periods of the transient and of the record
    phase : of the stroboscopic section, as a share of the period in [0, 1)
    most : impacts recorded of each period, more than any chattering sequence of the catalogue has at a restitution
        of 0.8; their number is recorded in any case, so where it is larger the rest is known to be missing
    executor, jobs, out, progress : see `lcpstep.sweep.sweep`

    Returns
    -------
    xarray.Dataset   on (run, <parameter>, period): q, v (with dimension `coordinate`), of systems with modes x (with
        dimension `state`); impacts (their number; of switches where there are modes), ends (chattering sequences and
        other landings; beginnings of sliding); status on (run, <parameter>); corner_phase on (<parameter>, corner).
        All impacts as one long list: impact_phase in [0, 1), impact_before, impact_after, and where each belongs,
        impact_value (index of the parameter's value), impact_run, impact_period, impact_number, impact_contact;
        likewise landing_phase, .., the ends of chattering sequences. Everything that it was made from is in the
        attributes.

    Raises
    ------
    TypeError    make gives no scene
    ValueError   values empty or not increasing, keep not positive, an unknown kind of start, a box missing, x0 inside
        of the obstacle at every value, or a name of the parameter that the dataset needs itself
    SweepStopped   the executor died; finished parts are kept in `out`
    """
    checks.function("make", make, f"{parameter}, by name, that makes a scene")
    check_free(parameter, TAKEN)
    values = checks.increasing(parameter, values)
    if start not in STARTS:
        raise ValueError(f"start: expected one of {', '.join(STARTS)}, got {start!r}")
    first, last = (_made(make, parameter, value) for value in (values[0], values[-1]))
    check_free(parameter, OF_STATES[type(first)])
    d = first.n_x
    study = _Study(
        make=make, parameter=parameter, values=values, method=method or EventDriven(), start=start,
        x0=checks.array("x0", np.zeros(d) if x0 is None else x0, (d,)), box=_box(box, d, start),
        runs=checks.count("runs", runs) if start == "random" else 1, seed=int(checks.number("seed", seed, least=0)),
        drop=int(checks.number("drop", drop, least=0)), keep=checks.count("keep", keep), phase=section(phase),
        most=checks.count("most", most),
    )  # fmt: skip
    order = range(len(values)) if start != "backward" else range(len(values) - 1, -1, -1)
    parts = [list(order)[i : i + PART] for i in range(0, len(values), PART)]
    chains = [parts] if start in ("forward", "backward") else [[part] for part in parts]
    known = {"scenes_sha256": [checksum(scene) for scene in (first, last)], "make_sha256": checksum_of(make)}
    inputs = study.inputs(first) | known
    done = sweep(study, chains, inputs, out=out, executor=executor, jobs=jobs, progress=progress)
    rows = [row for chain in done for row in chain]
    if all(np.all(row["status"] == INSIDE) for row in rows):
        where = "x0" if start != "random" else "box"
        raise ValueError(f"{where}: the motion starts inside of the obstacle at every value of {parameter}")
    return study.dataset(first, rows)


def _made(make: Callable[..., Any], parameter: str, value: float) -> Scene | HybridScene:
    """The scene at a value of the parameter; TypeError where it is none."""
    scene = make(**{parameter: float(value)})
    if not isinstance(scene, (Scene, HybridScene)):
        raise TypeError(f"make: expected a scene at {parameter} = {value:g}, got {scene!r}")
    return scene


def _box(box: ArrayLike | None, d: int, start: str) -> Array:
    if start != "random":
        return np.zeros((2, d))
    if box is None:
        raise ValueError("box: random starts need the lowest and highest states to draw from")
    result = checks.array("box", box, (2, d))
    if np.any(result[0] > result[1]):
        raise ValueError(f"box: expected lowest and highest states, got {result.tolist()}")
    return result


def _name(make: Callable[..., Any]) -> str:
    """The same in every process, so that an interrupted run knows its own parts again."""
    if isinstance(make, partial):
        fixed = ", ".join(f"{key}={value!r}" for key, value in sorted(make.keywords.items()))
        return f"{_name(make.func)}({fixed})"
    return f"{getattr(make, '__module__', '')}.{getattr(make, '__qualname__', type(make).__qualname__)}"


@dataclass(frozen=True, eq=False)
class _Study:
    """What every part of the sweep knows; called with the indices of the values of the part."""

    make: Callable[..., Scene | HybridScene]
    parameter: str
    values: Array
    method: Method
    start: str
    x0: Array
    box: Array
    runs: int
    seed: int
    drop: int
    keep: int
    phase: float
    most: int

    def __call__(self, part: list[int], handed: Arrays | None) -> tuple[Arrays, Arrays | None]:
        x = self.x0 if handed is None else handed["x"]
        rows: list[Arrays] = []
        lists: list[Arrays] = []
        for i in part:
            given = self.start == "random" or np.array_equal(x, self.x0)  # and not where the neighbour ended
            scene = self.make(**{self.parameter: float(self.values[i])})
            found = periods(
                scene, self.method, self.starts(i, x), self.drop + self.keep, drop=self.drop,
                phase=self.phase, most=self.most, strict=given,
            )  # fmt: skip
            continued = self.start in ("forward", "backward") and found.status[0] == Status.DONE
            x = found.final[0] if continued else self.x0
            rows.append({
                "states": found.states, "impacts": found.impacts.astype(np.int32),
                "ends": found.ends.astype(np.int32), "status": found.status.astype(np.int8),
            })  # fmt: skip
            lists.append(listed(found, scene.period, i))
        arrays: Arrays = {name: np.stack([row[name] for row in rows], axis=1) for name in rows[0]}
        return arrays | joined(lists) | {"index": np.array(part)}, {"x": x}

    def starts(self, i: int, x: Array) -> Array:
        """States to start from at the i-th value; random ones depend on the seed and on i alone."""
        if self.start != "random":
            return x[None, :]
        random = np.random.default_rng([self.seed, i])
        return random.uniform(self.box[0], self.box[1], (self.runs, len(x)))

    def corners(self) -> Array:
        """(values, corners) phases of the corners of the forcing; nan where a scene has fewer than others."""
        scenes = [self.make(**{self.parameter: float(value)}) for value in self.values]
        phases = [np.atleast_1d(np.asarray(s.corners, dtype=float)) / s.period % 1.0 for s in scenes]
        table = np.full((len(phases), max(map(len, phases))), np.nan)
        for row, found in zip(table, phases, strict=True):
            row[: len(found)] = found
        return table

    def inputs(self, first: Scene | HybridScene) -> dict[str, Any]:
        """What the result depends on."""
        names = ("start", "runs", "seed", "drop", "keep", "phase", "most")
        return provenance(first, self.method) | {
            "make": _name(self.make), "parameter": self.parameter, "values": self.values.tolist(),
            "x0": self.x0.tolist(), "box": self.box.tolist(), **{name: getattr(self, name) for name in names},
        }  # fmt: skip

    def dataset(self, first: Scene | HybridScene, parts: list[Arrays]) -> Any:
        """All parts in the order of the values."""
        order = np.argsort(np.concatenate([part["index"] for part in parts]))
        table = {
            name: np.concatenate([part[name] for part in parts], axis=1)[:, order]
            for name in ("states", "impacts", "ends", "status")
        }
        lists = joined(
            [{k: x for k, x in part.items() if k.startswith(("impact_", "landing_"))} for part in parts]
        )
        at = ("run", self.parameter, "period")
        if isinstance(first, HybridScene):
            states = {"x": ((*at, "state"), table["states"])}
        else:
            n = first.n_q
            states = {
                "q": ((*at, "coordinate"), table["states"][..., :n]),
                "v": ((*at, "coordinate"), table["states"][..., n:]),
            }
        variables = {
            **states,
            "impacts": (at, table["impacts"]),
            "ends": (at, table["ends"]),
            "status": (at[:2], table["status"]),
            "corner_phase": ((self.parameter, "corner"), self.corners()),
            **{name: ((name.split("_")[0],), x) for name, x in lists.items()},
        }
        attributes = {k: v for k, v in self.inputs(first).items() if k not in ("values", "box")}
        attributes |= {"labels": list(first.labels), "modes": int(isinstance(first, HybridScene))}
        attributes |= {"box": self.box.ravel()} if self.start == "random" else {}
        own = {} if attributes["modes"] else units(first.labels)
        return labelled(variables, {self.parameter: self.values}, attributes, own)
