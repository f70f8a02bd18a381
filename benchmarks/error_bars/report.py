"""Tables of how right error bars were."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from benchmarks.error_bars.truth import FRICTION, MEASURES, METHODS

ROWS = (*METHODS, *FRICTION)
WITHIN = 2.0  # the factor that a bar may be off
SLOW = 0.01  # CPU seconds of a run from which on costs are compared: below it both are overhead


class Judged(NamedTuple):
    """A measure of a run: how it could be judged, what the bar says, the true error, and how far that may be off."""

    kind: str
    bar: float
    error: float
    unsure: float

    @property
    def ratio(self) -> float:
        """True error over bar."""
        return self.error / self.bar if self.bar > 0.0 else math.inf if self.error > 0.0 else 1.0

    @property
    def right(self) -> bool:
        """Whether the two are within the factor."""
        return 1.0 / WITHIN <= self.ratio <= WITHIN


@dataclass
class Outcome:
    """A run: share of the span over which its bar holds, why it ends, and what the bar cost in runs."""

    scene: int
    family: str
    method: str
    until: float = 0.0
    reason: str = ""
    cost: float = math.nan
    seconds: float = 0.0
    measures: dict[str, Judged] = field(default_factory=dict)

    def of(self, kind: str) -> dict[str, Judged]:
        """Measures of a kind."""
        return {m: x for m, x in self.measures.items() if x.kind == kind}

    def __str__(self) -> str:
        wrong = [
            f"{m}: {x.error:.2e} / {x.bar:.2e} ({x.unsure:.1e})"
            for m, x in self.of("judged").items()
            if not x.right
        ]
        text = "; ".join(wrong) or "right"
        return f"{self.scene} {self.family} {self.method}, {self.until:.2f} of the span: {text}"


def tables(outcomes: Sequence[Outcome], seed: int) -> str:
    """All of it as markdown."""
    scenes = len({x.scene for x in outcomes})
    head = f"{len(outcomes)} runs on {scenes} random scenes, seed {seed}.\n"
    lines = [
        head,
        "| method | runs | bar over the whole span | ends early | none | judged | every measure within a factor 2 |",
        "|---|---|---|---|---|---|---|",
    ]
    for name in ROWS:
        own = [x for x in outcomes if x.method == name]
        bars = [x for x in own if x.measures]
        seen = [x for x in bars if x.of("judged")]
        right = sum(all(m.right for m in x.of("judged").values()) for x in seen)
        whole = sum(not x.reason for x in bars)
        row = (
            name,
            len(own),
            whole,
            len(bars) - whole,
            len(own) - len(bars),
            len(seen),
            _share(right, len(seen)),
        )
        lines.append("| " + " | ".join(map(str, row)) + " |")
    lines += ["", "| measure | " + " | ".join(ROWS) + " |", "|---|" + "---|" * len(ROWS)]
    for m in MEASURES:
        cells = [
            _cell([x.measures[m] for x in outcomes if x.method == name and m in x.measures]) for name in ROWS
        ]
        lines.append(f"| {m} | " + " | ".join(cells) + " |")
    lines += ["", *_costs(outcomes)]
    return "\n".join(lines)


def _cell(found: Sequence[Judged]) -> str:
    seen = [x for x in found if x.kind == "judged"]
    if not seen:
        return "none judged"
    ratios = [x.ratio for x in seen]
    right = _share(sum(x.right for x in seen), len(seen))
    others = [sum(x.kind == kind for x in found) for kind in ("rounding", "not known")]
    return f"{right}; {min(ratios):.2g} to {max(ratios):.2g} ({len(seen)}, {others[0]}, {others[1]})"


def _share(part: int, whole: int) -> str:
    return f"{100.0 * part / whole:.0f} %" if whole else ""


def _costs(outcomes: Sequence[Outcome]) -> list[str]:
    lines = []
    for name in ROWS:
        own = [x.cost for x in outcomes if x.method == name and x.seconds > SLOW]
        if own:
            low, high = np.quantile(own, [0.5, 0.9])
            lines.append(
                f"- {name}: the bar takes {low:.1f} times the run (median of {len(own)} runs of more than "
                f"{1e3 * SLOW:g} ms; {high:.1f} in nine of ten)"
            )
    return lines
