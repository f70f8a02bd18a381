"""What a study found: errors and costs of every method at every level, orders, and how far all this can be trusted.

The diagram of error over CPU time is that of E. Hairer, G. Wanner, Solving Ordinary Differential Equations II
(Springer 1996), section IV.10.
"""

from __future__ import annotations

import csv
import hashlib
import json
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from lcpstep.accuracy.orders import Cost, Order, cost_of, fitted_order
from lcpstep.errors import DamagedFile
from lcpstep.files import replacing

UNFIT = ("unmatched", "penetration")  # measures that follow no power of h
COLUMNS = (
    "method",
    "dial",
    "value",
    "status",
    "seconds",
    "repeats",
    "steps",
    "lcp_calls",
    "force_evaluations",
)


@dataclass(frozen=True)
class Level:
    """A method at one step or tolerance: means over the runs at nearby values.

    Attributes
    ----------
    method : name of the curve; `settings` says the method in full
    dial, value : what sets the accuracy ("h", "rtol", ...), and its geometric mean over the runs
    status : DONE, or why there are no errors here; `message` in words
    errors : mean error by measure; `scatter` the smallest and the largest of the runs
    seconds : CPU time, median over all repeated runs; these keep only the last state and the impact log [s]
    repeats : runs that were timed
    steps, lcp_calls, force_evaluations : means over the runs
    limited : measures whose error is within ten times what the reference may be off
    rounded : measures whose error is rounding alone
    separated : whether the motion has lost the reference, so that its errors only say how large the motion is
    bars : true error over the error bar of the run at the middle one of the nearby values, by measure
    """

    method: str
    settings: str
    dial: str
    value: float
    status: str
    message: str = ""
    errors: dict[str, float] = field(default_factory=dict)
    scatter: dict[str, tuple[float, float]] = field(default_factory=dict)
    seconds: float = math.nan
    repeats: int = 0
    steps: float = math.nan
    lcp_calls: float = math.nan
    force_evaluations: float = math.nan
    limited: tuple[str, ...] = ()
    rounded: tuple[str, ...] = ()
    separated: bool = False
    bars: dict[str, float] = field(default_factory=dict)


@dataclass(eq=False)
class Study:
    """A work-precision study.

    Attributes
    ----------
    question : scene, its parameters, span, measures, spread: what must be equal for two studies to be one
    reference, uncertainty : what errors are measured against, and how far that may be off, by measure
    compared_until : the motions are compared, and timed, up to here [s]
    growth : how fast a disturbance of the start grows, in words
    levels : list of Level, coarse to fine within each method
    notes : everything that was left out, and why
    units : of each measure
    finished : False for a study that was interrupted
    versions, machine : with what it was measured
    """

    question: dict[str, Any]
    reference: str
    uncertainty: dict[str, float]
    compared_until: float
    growth: str
    levels: list[Level] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    units: dict[str, str] = field(default_factory=dict)
    finished: bool = False
    versions: dict[str, str] = field(default_factory=dict)
    machine: dict[str, str] = field(default_factory=dict)

    @property
    def methods(self) -> list[str]:
        """Names of the curves."""
        return list(dict.fromkeys(level.method for level in self.levels))

    @property
    def measures(self) -> list[str]:
        """Names of the error measures."""
        return list(self.question["measures"])

    def titled(self, measure: str) -> str:
        """A measure with its unit, for tables and axes."""
        unit = self.units.get(measure, "1")
        return measure if unit == "1" else f"{measure} [{unit}]"

    def curve(self, method: str, measure: str, trusted: bool = True) -> list[Level]:
        """Levels of a method that have this error; `trusted`: not separated, limited by the reference, or rounded."""
        return [
            x
            for x in self.levels
            if x.method == method
            and math.isfinite(x.errors.get(measure, math.nan))
            and not (trusted and (x.separated or measure in x.limited or measure in x.rounded))
        ]

    def order(self, method: str, measure: str = "sup_position") -> Order | None:
        """Fitted order of a method, over the levels to be trusted; None where they are too few."""
        levels = self.curve(method, measure)
        return fitted_order([x.value for x in levels], [x.errors[measure] for x in levels])

    def cost(self, method: str, error: float, measure: str = "sup_position") -> Cost | None:
        """CPU time that a method takes for an error, between its levels or extrapolated."""
        levels = self.curve(method, measure)
        return cost_of(error, [x.errors[measure] for x in levels], [x.seconds for x in levels])

    def orders(self) -> dict[str, dict[str, Order]]:
        """All fitted orders, by method and measure."""
        fits = {m: {e: self.order(m, e) for e in self.measures if e not in UNFIT} for m in self.methods}
        return {m: {e: fit for e, fit in of_m.items() if fit is not None} for m, of_m in fits.items()}

    def save(self, path: str | Path) -> None:
        """Write everything to a .json file, or the levels to a .csv file with the settings as comments.

        The file is replaced in one go: whoever interrupts this finds the old one.

        Raises
        ------
        ValueError   another ending
        NotWritten   there is no space for it, or no permission
        """
        path = Path(path)
        if path.suffix not in (".json", ".csv"):
            raise ValueError(f"save: expected a name that ends in .json or .csv, got {path.name!r}")
        with replacing(path) as draft:
            if path.suffix == ".json":
                stored = self.as_dict()
                draft.write_text(json.dumps(stored | {"checksum": checksum(stored)}, indent=1) + "\n")
            else:
                self._write_csv(draft)

    def as_dict(self) -> dict[str, Any]:
        """Everything as numbers and texts; an error that is not finite is null."""
        orders = {m: {e: asdict(fit) for e, fit in of_m.items()} for m, of_m in self.orders().items()}
        return _plain(asdict(self) | {"orders": orders})

    @classmethod
    def load(cls, path: str | Path) -> Study:
        """A study from the .json file that `save` wrote.

        Raises
        ------
        DamagedFile   a study that has been changed since, was cut off, or is of another version
        ValueError   something else
        """
        try:
            stored = json.loads(Path(path).read_bytes())
        except ValueError as error:
            raise DamagedFile(f"{path} holds no whole study: {error}") from error
        if not (isinstance(stored, dict) and {"question", "levels"} <= stored.keys()):
            raise ValueError(f"{path} holds no study")
        if stored.pop("checksum", None) != checksum(stored):
            raise DamagedFile(f"{path} holds a study that was changed, or of another version")
        try:
            stored.pop("orders")
            return cls(levels=[_level(x) for x in stored.pop("levels")], **stored)
        except (KeyError, TypeError) as error:
            raise DamagedFile(f"{path} holds a study of another version: {error}") from error

    def _write_csv(self, path: Path) -> None:
        facts = {k: v for k, v in self.as_dict().items() if k not in ("levels", "orders")}
        with path.open("w", newline="") as file:
            file.writelines(f"# {name}: {json.dumps(value)}\n" for name, value in facts.items())
            out = csv.writer(file)
            out.writerow([*COLUMNS, *self.measures, "limited", "rounded", "separated"])
            for x in self.levels:
                row = [getattr(x, name) for name in COLUMNS]
                row += [x.errors.get(m, "") for m in self.measures]
                out.writerow([*row, " ".join(x.limited), " ".join(x.rounded), x.separated])

    def _bars(self, method: str) -> str:
        """From where to where the errors of a method are its bars, over the levels to be trusted."""
        found = {}
        for m in self.measures:
            ratios = [x.bars[m] for x in self.curve(method, m) if m in x.bars]
            if ratios:
                found[m] = f"{m} {min(ratios):.2g} to {max(ratios):.2g}"
        return ", ".join(found.values())

    def __repr__(self) -> str:
        return f"Study({self.question['scene']}, {len(self.levels)} levels of {', '.join(self.methods)})"

    def __str__(self) -> str:
        shown = [m for m in self.measures if any(m in x.errors for x in self.levels)]
        head = ["method", "at", "CPU [s]", "steps", "LCPs", "forces", *map(self.titled, shown)]
        rows = [head] + [_row(x, shown) for x in self.levels]
        widths = [max(len(r[k]) for r in rows) for k in range(len(head))]
        lines = ["  ".join(c.ljust(w) for c, w in zip(r, widths, strict=True)).rstrip() for r in rows]
        for method, fits in self.orders().items() if self.finished else ():
            lines += [f"order of {method} in {e}: {fit}" for e, fit in fits.items()]
        for method in self.methods:
            lines += [f"error over error bar of {method}: {text}" for text in [self._bars(method)] if text]
        lines += [f"reference: {self.reference}", f"growth: {self.growth}"]
        if any(x.limited for x in self.levels):
            lines.append("~ the reference is not known well enough for this error")
        if any(set(x.rounded) - set(x.limited) for x in self.levels):
            lines.append("= this error is rounding, and falls no further")
        if any(x.separated for x in self.levels):
            lines.append("! the motion has lost the reference: this error says only how large the motion is")
        return "\n".join([*lines, *(f"note: {x}" for x in self.notes)])


def checksum(stored: dict[str, Any]) -> str:
    """Of a study as numbers and texts."""
    return hashlib.sha256(json.dumps(stored).encode()).hexdigest()


def _level(stored: dict[str, Any]) -> Level:
    """A level from JSON, where null stands for what is not finite."""
    numbers = ("value", "seconds", "steps", "lcp_calls", "force_evaluations")
    nan: dict[str, Any] = {k: math.nan for k in numbers if stored[k] is None}
    errors = {m: math.inf if e is None else e for m, e in stored["errors"].items()}
    scatter = {m: tuple(math.inf if e is None else e for e in pair) for m, pair in stored["scatter"].items()}
    marks: dict[str, Any] = {name: tuple(stored.get(name, ())) for name in ("limited", "rounded")}
    return Level(**stored | nan | marks | {"errors": errors, "scatter": scatter})


def _row(x: Level, shown: Iterable[str]) -> list[str]:
    row = [x.method, f"{x.dial} = {x.value:.3g}" if x.dial else ""]
    if x.status != "DONE":
        return [*row, x.status, *[""] * (3 + len(list(shown)))]
    row += [f"{x.seconds:.3g}", *(f"{n:.0f}" for n in (x.steps, x.lcp_calls, x.force_evaluations))]
    return row + [f"{x.errors[m]:.2e}{_mark(x, m)}" if m in x.errors else "" for m in shown]


def _mark(x: Level, measure: str) -> str:
    return "~" if measure in x.limited else "=" if measure in x.rounded else "!" if x.separated else ""


def _plain(x: Any) -> Any:
    """The same in what JSON knows."""
    if isinstance(x, dict):
        return {str(k): _plain(v) for k, v in x.items()}
    if isinstance(x, (list, tuple)):
        return [_plain(v) for v in x]
    if isinstance(x, float) and not math.isfinite(x):
        return None
    return x
