"""What the studies come to: orders, errors at equal CPU time, cost of a step, and which h for a wanted error."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

from benchmarks.work_precision.cost import StepCost
from benchmarks.work_precision.tables import error_at, table
from lcpstep.accuracy.orders import cost_of
from lcpstep.accuracy.work_precision import Level, Study

OWN, POSITION = "Moreau", "sup_position"
WANTED = (1e-3, 1e-5, 1e-7, 1e-9)


def summary(studies: Mapping[str, Study], per_step: Sequence[StepCost]) -> str:
    """All of it."""
    parts = [
        "## Summary\n",
        "Fitted order of the position error [95 %], and the decades of h it holds over; below, the largest error.\n",
        orders(studies),
        "Error of the library's own Moreau, in as much CPU time, over the method's: range over its levels.\n",
        equal_time(studies),
        "One step beside the library's own Moreau, both with the last state kept, at equal h.\n",
        steps(per_step),
        "Step for a wanted error and its CPU s; *italics*: extrapolated; any: more accurate at every level.\n",
        which_step(studies),
    ]
    return "\n".join(parts)


def located(studies: Mapping[str, Study]) -> list[str]:
    """The methods that place impacts."""
    return list(dict.fromkeys(m for s in studies.values() for m in s.methods if m.startswith("Located")))


def orders(studies: Mapping[str, Study]) -> str:
    """Order, decades and largest error of every time-stepping method on every scene."""
    methods = [OWN, *located(studies)]
    rows = [[name, *(_order(study, m) for m in methods)] for name, study in studies.items()]
    return table(["scene", *methods], rows)


def _order(study: Study, method: str) -> str:
    fit, levels = study.order(method), study.curve(method, POSITION)
    everywhere = [x.errors[POSITION] for x in study.curve(method, POSITION, trusted=False)]
    if not everywhere:
        return ""
    if fit is None or fit.points < 3 or max(everywhere) < 1e-11:
        return f"error at most {max(everywhere):.0e}"
    return f"{fit}, {math.log10(levels[0].value / levels[-1].value):.1f}"


def equal_time(studies: Mapping[str, Study]) -> str:
    """How many times less wrong than Moreau in the same time."""
    rows = []
    for name, study in studies.items():
        cells = [_gain(study, m) for m in located(studies)]
        rows.append([name, *cells])
    return table(["scene", *located(studies)], rows)


def _gain(study: Study, method: str) -> str:
    longest = max(x.seconds for x in study.curve(OWN, POSITION, trusted=False))
    levels = [x for x in study.curve(method, POSITION, trusted=False) if x.errors[POSITION] > 0.0]
    levels = [x for x in levels if x.seconds <= longest]
    pairs = [(error_at(study, OWN, x.seconds), x.errors[POSITION]) for x in levels]
    gains = [own / it for own, it in pairs if own is not None]
    return f"{min(gains):.1g} .. {max(gains):.1g}" if gains else ""


def steps(per_step: Iterable[StepCost]) -> str:
    """What a step costs."""
    rows = [
        [
            c.scene, f"{c.h:g}", f"{1e9 * c.moreau:.0f}", f"{1e9 * c.located:.0f}", f"{c.ratio:.2f}",
            f"{c.impacts:.2g}", f"{c.moreau_error:.0e}", f"{c.located_error:.0e}", f"{c.penetration:.0e}",
        ]
        for c in per_step
    ]  # fmt: skip
    head = ["scene", "h [s]", "Moreau [ns]", "Located [ns]", "ratio", "impacts a step", "error of Moreau"]
    return table([*head, "error of Located", "its penetration"], rows)


def which_step(studies: Mapping[str, Study]) -> str:
    """The step that a wanted error asks for."""
    rows = []
    for name, study in studies.items():
        for method in [m for m in study.methods if m == OWN or m.startswith("Located")]:
            rows.append([name, method, *(_step(study, method, error) for error in WANTED)])
    return table(["scene", "method", *(f"{error:g}" for error in WANTED)], rows)


def _step(study: Study, method: str, error: float) -> str:
    levels = study.curve(method, POSITION, trusted=False)
    if not levels:
        return ""
    if all(x.errors[POSITION] <= error for x in levels):
        return f"any: {min(x.seconds for x in levels):.1e}"
    # Steps that have lost the reference bound the range from above: with them the error is too large.
    step, cost = (cost_of(error, *_columns(levels, what)) for what in ("value", "seconds"))
    if step is None or cost is None or step.extrapolated:
        levels = study.curve(method, POSITION)
        step, cost = (cost_of(error, *_columns(levels, what)) for what in ("value", "seconds"))
    if step is None or cost is None:
        return "not known"
    text = f"{step.seconds:.1e}: {cost.seconds:.1e}"
    return f"*{text}*" if step.extrapolated else text


def _columns(levels: Sequence[Level], what: str) -> tuple[list[float], list[float]]:
    return [x.errors[POSITION] for x in levels], [getattr(x, what) for x in levels]
