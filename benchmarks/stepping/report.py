"""The figures as tables of Markdown."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

FLOOR = """
Time of one step of Moreau's theta-method (theta = 1/2, one contact), of {steps} steps: the time of the
whole call divided by the number of steps. `floor` is the loop written by hand for that one scene
(`floor.py`); "kept" has every state in arrays at the end, otherwise the first and last only. The floor's
motion is the library's up to the difference in the last column. Ratios are medians of the ratios within a
round. Aim: at most 3 without storage.
"""
SICONOS = """
The same scene, step and theta. The library's time is that of the whole call of `simulate`, every state
kept; Siconos' is that of its time loop alone, nothing kept, the model built before the clock starts: *C++
loop* is `TimeStepping.run` with the force in a C plugin, *Python loop* the same steps driven from Python,
*Python force* with the force a Python function as well. Errors are sup norms of the position; "mean" is
that over six neighbouring steps, because the error of a single step scatters by a factor of ten. "Apart" is
the largest difference between the two programs' positions at the same step.
"""
EVENTS = """
Time of a whole run of `EventDriven`, and of that time per impact. Errors against the closed form (ball) and
against a computation to fifty digits (oscillator, cam); of the user's scenes against the same integrator at
1e-13. A harmonic or constant force, or one from a moving frame, is integrated in closed form, so tolerances
matter for chattering only; the user's scenes take the Runge-Kutta method.
"""
FIRST = """
Seconds of the first and the second call in a fresh process, and what the kernels cost once per machine
("empty cache"). "New scene": the kernels are in the cache, the user's callbacks have never been seen.
"Seen": all is in the cache.
"""


def markdown(figures: dict[str, Any]) -> str:
    """The whole results file."""
    parts = [
        "# Speed and error of the two integrators",
        _where(figures),
        "## Time-stepping: a step",
        FLOOR.strip(),
    ]
    parts[-1] = parts[-1].format(steps=f"{figures['moreau'][0]['steps']:,}".replace(",", " "))
    parts += [floor_table(figures["moreau"]), call_line(figures["call"])]
    parts += ["## Time-stepping beside Siconos", SICONOS.strip(), siconos_table(figures["equal_steps"])]
    parts += ["## Event by event", EVENTS.strip(), events_table(figures["events"])]
    if figures.get("siconos_events"):
        parts += [
            "Siconos' `EventDriven` (LSODAR), stopped at 100 times:",
            peer_events(figures["siconos_events"]),
        ]
    if "first_use" in figures:
        parts += ["## First use", FIRST.strip(), first_table(figures["first_use"])]
    return "\n\n".join(parts) + "\n"


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = list(head)
    lines = ["| " + " | ".join(head) + " |", "|---" + "|---:" * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def floor_table(rows: list[dict[str, Any]]) -> str:
    head = ["scene", "h [s]", "floor [ns]", "library [ns]", "ratio", "floor, kept [ns]", "library, kept [ns]"]
    head += [
        "ratio, kept",
        "contact steps",
        "sup error of q [m]",
        "error of the first impact [s]",
        "floor apart [m]",
    ]
    return table(head, (_floor_row(row) for row in rows))


def _floor_row(row: dict[str, Any]) -> list[str]:
    contestants = ("floor", "library", "floor, stored", "library, stored")
    times = [spread(row.get(f"{name} [s/step]"), 1e9) for name in contestants]
    ratios = [_number(row["ratio"]), _number(row["ratio, stored"])]
    tail = [_small(row.get(key)) for key in ("sup_q", "first_impact", "floor_apart")]
    share = f"{100 * row['contact_share']:.2g} %"
    return [row["scene"], f"{row['h']:.1e}", *times[:2], ratios[0], *times[2:], ratios[1], share, *tail]


def call_line(rows: list[dict[str, Any]]) -> str:
    costs = ", ".join(f"{row['scene']} {spread(row, 1e3)}" for row in rows)
    return f"A call of `simulate` for a single step [ms]: {costs}. A short run pays this besides its steps."


def siconos_table(rows: list[dict[str, Any]]) -> str:
    if not any("run [s/run]" in row for row in rows):
        return "*Siconos was not found: its columns are missing.*\n\n" + _equal(rows, peer=False)
    return _equal(rows, peer=True)


def _equal(rows: list[dict[str, Any]], peer: bool) -> str:
    head = ["scene", "h [s]", "library [us/step]"]
    if peer:
        head += [
            "C++ loop [us/step]",
            "Python loop [us/step]",
            "Python force [us/step]",
            "C++ loop / library",
        ]
    head += ["error of the library [m]", "mean [m]", "first impact [s]"]
    head += ["error of Siconos [m]", "first impact [s]", "apart [m]"] if peer else []
    lines = []
    for row in rows:
        drivers = ("library", "run", "python", "force") if peer else ("library",)
        cells = [row["scene"], f"{row['h']:.0e}"]
        cells += [spread(row.get(f"{d} [s/run]"), 1e6 / row["steps"]) for d in drivers]
        cells += [_number(row.get("run / library"))] if peer else []
        keys = ["sup_q", "mean_sup_q", "first_impact"]
        keys += ["siconos_sup_q", "siconos_first_impact", "siconos_apart"] if peer else []
        lines.append(cells + [_small(row.get(key)) for key in keys])
    return table(head, lines)


def events_table(rows: list[dict[str, Any]]) -> str:
    head = ("scene", "rtol = atol", "impacts", "run [us]", "per impact [us]", "sup error of q [m]",
            "error of the first impact [s]", "of the accumulation time (relative)")  # fmt: skip
    cells = []
    for row in rows:
        times = [spread(row[name], 1e6) for name in ("run [s]", "impact [s]")]
        errors = [_small(row.get(name)) for name in ("sup_q", "first_impact", "accumulation")]
        cells.append([row["scene"], f"{row['tolerance']:.0e}", str(row["impacts"]), *times, *errors])
    return table(head, cells)


def peer_events(rows: list[dict[str, Any]]) -> str:
    head = ("scene", "tolerance", "impacts", "run [us]", "sup error of q [m]")
    lines = []
    for row in rows:
        tolerance = "default" if row["tolerance"] is None else f"{row['tolerance']:.0e}"
        tail = ["", "raises an exception", ""]
        if "run [s]" in row:
            tail = [str(row["impacts"]), spread(row["run [s]"], 1e6), _small(row["sup_q"])]
        lines.append([row["scene"], tolerance, *tail])
    return table(head, lines)


def first_table(first: dict[str, Any]) -> str:
    imports = ", ".join(f"{name} {spread(times, 1e3)}" for name, times in first["imports"].items())
    calls = first["calls"]
    rows = ([name, *(_small(calls[kind][name]) for kind in calls)] for name in calls["cold"])
    head = ("call", "empty cache [s]", "new scene [s]", "seen [s]")
    return f"Whole processes that import and end [ms]: {imports}.\n\n" + table(head, rows)


def _where(figures: dict[str, Any]) -> str:
    facts = figures["machine"]
    described = ", ".join(f"{key} {value}" for key, value in facts.items())
    return (
        f"Made by `python -m benchmarks.stepping`. {described}; Siconos {figures['siconos']}. "
        f"Medians of {figures['rounds']} rounds in which the contestants took turns, in brackets the shortest and "
        "longest. Times are those that the processor gave to the one thread at work, under *First use* wall "
        "times; the machine was shared, so ratios hold better than times."
    )


def spread(times: dict[str, float] | None, scale: float) -> str:
    """Median with shortest and longest."""
    if not times or math.isnan(times["median"]):
        return ""
    return f"{times['median'] * scale:.3g} ({times['low'] * scale:.3g} .. {times['high'] * scale:.3g})"


def _number(x: float | None) -> str:
    return "" if x is None or math.isnan(x) else f"{x:.1f}"


def _small(x: float | None) -> str:
    return "" if x is None or math.isnan(x) else ("0" if x == 0.0 else f"{x:.2g}")
