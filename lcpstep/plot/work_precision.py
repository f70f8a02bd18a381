"""Work-precision diagrams: errors over CPU time, and over the step or tolerance, on logarithmic scales.

The layout is that of E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (Springer 1996), IV.10.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lagrangian import checks
from lcpstep.accuracy.work_precision import UNFIT, Level, Study

MARKERS = "osD^vPX*<>"
FLOOR = "known of the reference"  # below it errors are the reference's own


def work_precision(study: Study, measures: Sequence[str] | None = None) -> Any:
    """One row a measure: error over CPU time on the left, over step or tolerance with fitted orders on the right.

    Bars reach from the smallest to the largest error of the nearby steps; hollow points are not to be trusted,
    because the reference is not good enough there or the motion has lost it. The grey line is what the
    reference itself may be off.
    """
    checks.instance("study", study, Study)
    from lcpstep.plot.figures import Figure

    wanted = measures or [
        m
        for m in study.measures
        if m not in UNFIT and any(drawable(x.errors.get(m, 0.0)) for x in study.levels)
    ]
    figure = Figure(figsize=(13.5, 3.6 * max(len(wanted), 1)), layout="constrained")
    figure.suptitle(f"{study.question['scene']}, compared up to {study.compared_until:.4g} s")
    grid = figure.subplots(max(len(wanted), 1), 2, sharey="row", squeeze=False)
    for row, measure in zip(grid, wanted, strict=False):
        for k, method in enumerate(study.methods):
            levels = [x for x in study.curve(method, measure, trusted=False) if drawable(x.errors[measure])]
            if not levels:
                continue
            order = study.order(method, measure)
            names = (method, method if order is None else f"order {order}")
            for ax, x, name in zip(row, ("seconds", "value"), names, strict=True):
                _curve(ax, levels, measure, x, f"C{k % 10}", MARKERS[k % len(MARKERS)], name)
        for ax, label in zip(row, ("CPU time [s]", "step h [s], or tolerance"), strict=True):
            ax.set(xscale="log", yscale="log", xlabel=label)
            if drawable(study.uncertainty.get(measure, 0.0)):
                ax.axhline(study.uncertainty[measure], color="0.6", lw=0.8, label=FLOOR)
            whole_decades(ax)
            ax.grid(alpha=0.3, which="both")
            if ax.get_legend_handles_labels()[0]:
                ax.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.01, 1.0), frameon=False)
        row[0].set_ylabel(study.titled(measure).replace("_", " "))
    return figure


def drawable(error: float) -> bool:
    """Whether an error has a place on a logarithmic scale; infinite is one of impacts that have no partner."""
    return 0.0 < error < np.inf


def whole_decades(ax: Any) -> None:
    """Limits of a logarithmic axis at powers of ten, whose labels then stay apart."""
    from matplotlib.ticker import LogLocator, NullFormatter

    low, high = np.log10(ax.get_xlim())
    ax.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
    ax.xaxis.set_major_locator(LogLocator(numticks=7))
    ax.xaxis.set_minor_formatter(NullFormatter())


def _curve(
    ax: Any, levels: Sequence[Level], measure: str, x: str, colour: str, marker: str, name: str
) -> None:
    at = np.array([getattr(level, x) for level in levels])
    errors = np.array([level.errors[measure] for level in levels])
    low, high = np.array([level.scatter[measure] for level in levels]).reshape(-1, 2).T
    bars = [np.minimum(errors - low, 0.999 * errors), high - errors]
    ax.errorbar(at, errors, yerr=bars, color=colour, marker="", lw=1.0, elinewidth=0.6, capsize=2)
    trusted = np.array([not (x.separated or measure in (*x.limited, *x.rounded)) for x in levels], dtype=bool)
    ax.plot(at[trusted], errors[trusted], marker, color=colour, label=name)
    ax.plot(at[~trusted], errors[~trusted], marker, color=colour, mfc="none")
