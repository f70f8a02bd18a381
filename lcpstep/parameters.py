"""Parameter studies as text: a scene, a method, what varies and what is measured, in TOML; the result carries it.

scene = "bouncing-ball"            # a ready scene, or a file with a function scene()
t_end = 5.0

[method]
name = "located"                   # moreau, located, event-driven
h = 1e-3

[parameters]
h0 = 2.0

[sweep]                            # every combination is run
restitution = [0.2, 0.5, 0.8]
g = { from = 1.6, to = 9.81, points = 5 }

[outputs]
measures = ["impacts", "impulse", "q_end"]
file = "study.nc"
"""

from __future__ import annotations

import itertools
import math
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from lagrangian import HybridScene, Scene, checks
from lagrangian.labels import common_unit, own_unit
from lcpstep import dataset
from lcpstep.errors import LcpStepError, SimulationError, UnknownName
from lcpstep.events import EventDriven
from lcpstep.recording import Keep
from lcpstep.simulation import Method, simulate
from lcpstep.stepping.located import Located
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Status, Trajectory, blows

METHODS: dict[str, type] = {"moreau": Moreau, "located": Located, "event-driven": EventDriven}
TOP = ("scene", "t_end", "method", "parameters", "sweep", "outputs")
RANGE = ("from", "to", "points", "scale")
OUTPUTS = ("measures", "file", "table", "picture", "runs")
SCALES: dict[str, Callable[..., Any]] = {"linear": np.linspace, "log": np.geomspace}
MEASURES: dict[str, tuple[str, Callable[[Any], Any]]] = {  # of a run: unit, value
    "q_end": ("m", lambda run: run.q[-1]),
    "v_end": ("m/s", lambda run: run.v[-1]),
    "t_reached": ("s", lambda run: run.t[-1]),
    "impacts": ("1", lambda run: len(blows(run.impacts))),
    "impulse": ("N s", lambda run: float(np.sum(run.impacts.impulse))),
    "strongest": ("N s", lambda run: float(np.max(run.impacts.impulse, initial=0.0))),
    "fastest": ("m/s", lambda run: float(np.max(-run.impacts.before, initial=0.0))),
    "events": ("1", lambda run: len(run.impacts)),
    "steps": ("1", lambda run: run.counts.steps),
    "penetration": ("m", lambda run: float(np.max(run.penetration, initial=0.0))),
}
ERRORS: dict[str, tuple[str, Callable[[Any], Any]]] = {  # of an error bar: unit, value
    "position_error": ("m", lambda bar: bar.position.sup),
    "velocity_error": ("m/s", lambda bar: bar.velocity.sup),
    "impact_time_error": ("s", lambda bar: bar.latest),
    "impulse_error": ("N s", lambda bar: bar.strongest),
    "energy_error": ("J", lambda bar: bar.energy.sup),
    "known_until": ("s", lambda bar: bar.until),
}
VECTORS = ("q_end", "v_end")  # a number for every coordinate
ORDINARY = ("impacts", "impulse", "strongest", "q_end", "v_end")


@dataclass(frozen=True)
class ParameterStudy:
    """What a text asks for; `ParameterStudy.read` makes it.

    Attributes
    ----------
    text : the text itself, which the result carries
    scene : name of a ready scene, or of a file
    method : of every run
    fixed, sweep : parameters with one value, and with several
    outputs : measures, and names of files
    """

    text: str
    scene: str
    method: Method
    t_end: float | None
    fixed: Mapping[str, Any]
    sweep: Mapping[str, Sequence[Any]]
    outputs: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def read(cls, text: str, name: str = "study") -> ParameterStudy:
        """From TOML.

        Raises
        ------
        UnknownName   a key that nobody knows, with the nearest that is known
        ValueError   it is no TOML, or a value is not what its key takes; the message names both
        """
        try:
            given = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise ValueError(f"{name}: no TOML: {error}") from None
        _known(name, "key", given, TOP)
        _checked(f"{name}: scene", given.get("scene"), str, 'a name, as scene = "bouncing-ball"')
        sections = {part: _table(name, given, part) for part in ("method", "parameters", "sweep", "outputs")}
        _known(f"{name}: [outputs]", "key", sections["outputs"], OUTPUTS)
        for key in sections["outputs"].keys() - {"measures"}:
            _checked(f"{name}: [outputs]: {key}", sections["outputs"][key], str, "the name of a file")
        measures = sections["outputs"].get("measures", list(ORDINARY))
        if not isinstance(measures, list) or not measures:
            raise ValueError(f"{name}: [outputs]: measures: expected a list of names, got {measures!r}")
        _known(f"{name}: [outputs]", "measure", measures, MEASURES | ERRORS)
        fixed = {key: _single(f"{name}: [parameters]: {key}", x) for key, x in sections["parameters"].items()}
        sweep = {key: _values(f"{name}: [sweep]: {key}", x) for key, x in sections["sweep"].items()}
        t_end = None if "t_end" not in given else checks.positive(f"{name}: t_end", given["t_end"])
        twice = sorted(set(sweep) & set(fixed))
        if twice:
            raise ValueError(f"{name}: {', '.join(twice)}: given in [parameters] and in [sweep]")
        return cls(
            text, given["scene"], _method(name, sections["method"]), t_end, fixed, sweep,
            sections["outputs"] | {"measures": measures},
        )  # fmt: skip

    @property
    def tells_errors(self) -> bool:
        """Whether every run gets an error bar."""
        return any(name in ERRORS for name in self.outputs["measures"])

    @property
    def points(self) -> list[dict[str, Any]]:
        """Parameters of every run."""
        return [
            {**self.fixed, **dict(zip(self.sweep, values, strict=True))}
            for values in itertools.product(*self.sweep.values())
        ]

    def run(
        self,
        make: Callable[[Mapping[str, Any]], Scene],
        progress: Callable[[int, int], None] | None = None,
        kept: Callable[[int, Trajectory], None] | None = None,
        found: Callable[[int, Scene], Trajectory | None] | None = None,
    ) -> Any:
        """Run every combination.

        Parameters
        ----------
        make : from parameters to the scene
        progress : called with the runs that are done, and all
        kept : called with the number of each run and its trajectory, all steps of it
        found : the run of that number and scene that has been made before, all steps of it, or None; asked for all
            before any work starts, so that it may refuse, and for each again where it is needed

        Returns
        -------
        xarray.Dataset : each measure over the swept parameters, and how each run ended; its attribute `study` is the
            text, `scene`, `method` and the versions are others

        Raises
        ------
        ValueError   a swept parameter has the name of a measure, or a measure by coordinates is asked for where the
            number of these is swept
        """
        measures = self.outputs["measures"]
        for name in self.sweep:
            dataset.check_free(name, {"status", "coordinate", *measures})
        points = self.points
        scenes = [make(point) for point in points]  # all of them before any work starts
        if modes := next((x for x in scenes if isinstance(x, HybridScene)), None):
            raise LcpStepError(
                f"scene: {modes.name!r} has modes; parameter studies take scenes with contacts"
            )
        counts = sorted({scene.n_q for scene in scenes})
        if len(counts) > 1 and (wide := [name for name in VECTORS if name in measures]):
            raise ValueError(
                f"measures: {', '.join(wide)}: the scenes have {', '.join(map(str, counts))} coordinates, which "
                f"make no array; leave them out"
            )
        there = {k for k, scene in enumerate(scenes) if found is not None and found(k, scene) is not None}
        rows, ended = [], []
        for k, scene in enumerate(scenes):
            run = found(k, scene) if found is not None and k in there else None
            if run is None:
                run = self._one(scene, 1 if kept or self.tells_errors or "penetration" in measures else None)
                if kept is not None:
                    kept(k, run)
            rows.append({name: _measured(name, run) for name in measures})
            ended.append(run.status.name)
            if progress is not None:
                progress(k + 1, len(points))
        return self._labelled(scenes[0], rows, ended)

    def _one(self, scene: Scene, keep: int | None) -> Trajectory:
        """One run; one that fails is what it was up to there."""
        what: Keep = keep or "impacts"  # the last state with them, wherever the run ends
        try:
            return simulate(scene, self.method, keep=what, error=self.tells_errors)
        except SimulationError as error:
            found: Trajectory = error.trajectory
            if found.status == Status.DONE:  # no motion that fails, but a scene with a wrong derivative
                raise
            return found

    def _labelled(self, scene: Scene, rows: list[dict[str, Any]], ended: list[str]) -> Any:
        """The measures as arrays over the swept parameters."""
        shape, names = tuple(map(len, self.sweep.values())), tuple(self.sweep)
        variables: dict[str, Any] = {"status": (names, np.array(ended).reshape(shape))}
        n, units = scene.n_q, {}
        labels = dict.fromkeys(("q_end", "position_error"), scene.labels[:n])
        labels |= dict.fromkeys(("v_end", "velocity_error"), scene.labels[n:])
        own = {name: common_unit(of) or "1" for name, of in labels.items()}
        for name in self.outputs["measures"]:
            values = np.array([row[name] for row in rows])
            inner = ("coordinate",) if values.ndim > 1 else ()
            variables[name] = ((*names, *inner), values.reshape((*shape, *values.shape[1:])))
            units[name] = own.get(name) or own_unit((MEASURES | ERRORS)[name][0], scene.labels)
        coordinates = {key: np.asarray(values) for key, values in self.sweep.items()}
        attributes = dataset.provenance(scene, self.method) | {"study": self.text}
        return dataset.labelled(variables, coordinates, attributes, units)


def _measured(name: str, run: Trajectory) -> Any:
    """A measure of a run, nan for an error that is not known."""
    if name in MEASURES:
        return MEASURES[name][1](run)
    value = math.nan if run.error is None else float(ERRORS[name][1](run.error))
    return value if math.isfinite(value) else math.nan


def _known(where: str, what: str, given: Any, known: Any) -> None:
    """UnknownName for the first name that is not known."""
    if unknown := [key for key in given if key not in known]:
        raise UnknownName(f"{what} of {where}:", unknown[0], known)


def _table(name: str, given: Mapping[str, Any], part: str) -> dict[str, Any]:
    return _checked(f"{name}: {part}", given.get(part, {}), dict, f"a table, written under a line [{part}]")


def _single(where: str, given: Any) -> Any:
    """The value of a parameter."""
    return _checked(where, given, (bool, int, float, str), "a number, true, false or a text")


def _checked(where: str, given: Any, kinds: Any, words: str) -> Any:
    """What is given; ValueError unless it is of these kinds, in words."""
    if not isinstance(given, kinds):
        raise ValueError(f"{where}: expected {words}, got {given!r}")
    return given


def _method(name: str, given: Mapping[str, Any]) -> Method:
    """The method that [method] names."""
    which = given.get("name", "located")
    if which not in METHODS:
        raise UnknownName(f"method of {name}:", which, METHODS)
    kind: Any = METHODS[which]
    settings = {key: x for key, x in given.items() if key != "name"}
    _known(f"{name}: [method] {which}", "key", settings, [f.name for f in fields(kind)])
    made: Method = kind(**settings)
    return made


def _values(where: str, given: Any) -> list[Any]:
    """Values of a swept parameter: a list, or a range {from, to, points, scale}."""
    if isinstance(given, list) and given:
        return [_single(where, x) for x in given]
    if isinstance(given, dict):
        _known(where, "key", given, RANGE)
        missing = [key for key in RANGE[:3] if key not in given]
        if missing:
            raise ValueError(
                f"{where}: {', '.join(missing)}: missing; a range is {{from = 1, to = 2, points = 5}}"
            )
        scale = given.get("scale", "linear")
        if scale not in SCALES:
            raise UnknownName(f"scale of {where}:", scale, SCALES)
        ends = [checks.number(f"{where}: {key}", given[key]) for key in ("from", "to")]
        if scale == "log" and min(ends) <= 0.0:
            raise ValueError(f"{where}: expected positive ends of a logarithmic range, got {ends}")
        return list(SCALES[scale](*ends, checks.count(f"{where}: points", given["points"])).tolist())
    raise ValueError(f"{where}: expected a list of values, or {{from, to, points}}, got {given!r}")


def read_file(file: str | Path) -> ParameterStudy:
    """A study from a file; FileNotFoundError where there is none."""
    if not Path(file).is_file():
        raise FileNotFoundError(
            f"file: there is no file {str(file)!r}; docs/parameter-studies.md has one to start from"
        )
    try:
        text = Path(file).read_text(encoding="utf-8-sig")  # with a mark of the encoding before it, or without
    except UnicodeDecodeError as error:
        raise ValueError(f"{Path(file).name}: no TOML: {error}") from None
    return ParameterStudy.read(text, Path(file).name)
