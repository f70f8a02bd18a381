"""The figures as tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from benchmarks.work_precision.aims import OWN, summary
from benchmarks.work_precision.cost import StepCost
from benchmarks.work_precision.tables import error_at, table
from lcpstep.accuracy.orders import Cost
from lcpstep.accuracy.work_precision import Study

ERRORS = (1e-3, 1e-5, 1e-7)
TIMES = (1e-3, 1e-2, 1e-1)
PEER = "Siconos Moreau-Jean"

HEAD = """# Error against CPU time

Made by `python -m benchmarks.work_precision`. Errors are sup norms of the position [m], means over three nearby
steps; times are medians of repeated runs [CPU s]: the library's of whole calls of `simulate`, Siconos' of its
time loop alone. *Italics* are extrapolated along the fitted line, beyond the runs made. An error with ~ is not to be
trusted to its digits, since the reference is not known much better; with ! the motion has lost the reference, and
neither enters the fits. A method that is more accurate than asked for at every level has the time of its cheapest.
"""


def markdown(studies: Mapping[str, Study], per_step: Sequence[StepCost], siconos: str) -> str:
    """All tables."""
    first = next(iter(studies.values()))
    facts = ", ".join(f"{k} {v}" for k, v in {**first.versions, **first.machine, "Siconos": siconos}.items())
    parts = [HEAD, facts + ".\n", summary(studies, per_step)]
    for name, study in studies.items():
        parts += [f"## {name}\n", f"Reference: {study.reference}; {study.growth}.\n"]
        parts += [_levels(study), _orders(study), _at_errors(study), _at_times(study)]
        parts += [f"- {note}" for note in study.notes]
        parts.append("")
    return "\n".join(parts)


def _levels(study: Study) -> str:
    rows = []
    for x in study.levels:
        dial = f"{x.dial} = {x.value:.2g}"
        if x.status != "DONE":
            rows.append([x.method, dial, x.status, *[""] * 4])
            continue
        mark = "!" if x.separated else "~" if "sup_position" in x.limited else ""
        errors = [x.errors[m] for m in ("sup_position", "l1_velocity", "penetration")]
        rows.append(
            [x.method, dial, f"{x.seconds:.2e}", f"{x.steps:.0f}", f"{errors[0]:.1e}{mark}"]
            + [f"{e:.1e}" for e in errors[1:]]
        )
    return table(
        ["method", "level", "CPU s", "steps", "sup of position", "L1 of velocity", "penetration"], rows
    )


def _orders(study: Study) -> str:
    rows = []
    for method, fits in study.orders().items():
        cells = [
            f"{fits[m]} ({fits[m].points})" if m in fits else "" for m in ("sup_position", "l1_velocity")
        ]
        rows.append([method, *cells])
    return table(["fitted order [95 %] (levels)", "sup of position", "L1 of velocity"], rows)


def _at_errors(study: Study) -> str:
    """CPU time at equal error."""
    costs = {m: [_cost_of(study, m, e) for e in ERRORS] for m in study.methods}
    rows = []
    for method, of_it in costs.items():
        row = [method]
        for k, cost in enumerate(of_it):
            row.append(_cost(cost))
            row.append(_ratio(costs.get(PEER, [None] * len(ERRORS))[k], cost) if method != PEER else "")
        rows.append(row)
    head = ["CPU s for an error of"]
    for e in ERRORS:
        head += [f"{e:g}", "Siconos / it"]
    return table(head, rows)


def _cost_of(study: Study, method: str, error: float) -> Cost | None:
    """CPU time for an error; that of the cheapest level where even the coarsest is better."""
    levels = study.curve(method, "sup_position", trusted=False)
    if levels and all(x.errors["sup_position"] <= error for x in levels):
        return Cost(min(x.seconds for x in levels), False)
    return study.cost(method, error)


def _cost(cost: Cost | None) -> str:
    if cost is None:
        return "not known"
    return f"*{cost.seconds:.1e}*" if cost.extrapolated else f"{cost.seconds:.1e}"


def _ratio(above: Cost | None, below: Cost | None) -> str:
    if above is None or below is None:
        return ""
    text = f"{above.seconds / below.seconds:.2g}"
    return f"*{text}*" if above.extrapolated or below.extrapolated else text


def _at_times(study: Study) -> str:
    """Error at equal CPU time, and how many times smaller than that of the library's Moreau."""
    rows = []
    for method in study.methods:
        row = [method]
        for seconds in TIMES:
            own, it = error_at(study, OWN, seconds), error_at(study, method, seconds)
            row.append("" if it is None else f"{it:.1e}")
            row.append("" if own is None or it is None or method == OWN or it == 0.0 else f"{own / it:.2g}")
        rows.append(row)
    head = ["error at a CPU time of"]
    for seconds in TIMES:
        head += [f"{seconds:g} s", "Moreau / it"]
    return table(head, rows)
