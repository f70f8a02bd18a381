"""Pictures of attractors: impact map and stroboscopic map, one row a method.

The contents are those of G. Osorio, Complex Behavior in Impacting Systems, Fig 3.6: phase of the forcing against the
gap velocity after the impact, and position against velocity once per period.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import checks
from lagrangian.labels import own_unit
from lcpstep.plot import looks
from lcpstep.plot.bifurcation import LETTERS

Array = NDArray[np.float64]
ORDINALS = 6  # impacts of a period with a colour of their own; later ones share the last
LABELS = ("position [m]", "velocity [m/s]")
FEW, MANY = 5.0, 2.0  # sizes of a few points, and of thousands


def attractors(
    rows: Mapping[str, Sequence[Any]], title: str = "", corners: Sequence[float] = (),
    labels: Sequence[str] = LABELS,
) -> Any:  # fmt: skip
    """Figure of attractors (`lcpstep.analysis.attractors.Attractor`).

    Parameters
    ----------
    rows : attractors by the name of the method that found them
    corners : phases of the corners of the forcing, as shares of the period
    labels : of the states, with their units
    """
    checks.filled("rows", rows, Mapping, "lists of attractors by name")
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(13.0, 0.8 + 4.6 * len(rows)), layout="constrained")
    figure.suptitle(title)
    grid = figure.subplots(len(rows), 2, sharex="col", sharey="col", squeeze=False)
    for (left, right), (method, found) in zip(grid, rows.items(), strict=True):
        impact_panel(left, found, corners, labels)
        section_panel(right, found, labels)
        event = "switches" if any(a.modes for a in found) else "impacts"
        left.set_title(f"{event}: {method}", fontsize=10)
        right.set_title(f"once per period: {method}", fontsize=10)
    return figure


def impact_panel(
    ax: Any, found: Sequence[Any], corners: Sequence[float] = (), labels: Sequence[str] = LABELS
) -> None:
    """Phase and velocity after each impact, coloured by its number in the period; rate before each switch."""
    phase, after, number = (
        np.concatenate([getattr(a, f"impact_{name}") for a in found] or [np.zeros(0)])
        for name in ("phase", "before" if any(a.modes for a in found) else "after", "number")
    )
    size = FEW if all(a.periods for a in found) else MANY
    seen = int(min(np.max(number, initial=1), ORDINALS))
    shades = looks.shades(seen)
    for k in range(1, seen + 1):
        which = number == k if k < ORDINALS else number >= k
        if np.any(which):
            label = f"{k}" if k < ORDINALS else f"{k} and later"
            dots(ax, phase[which], after[which], shades[k - 1], size, label, looks.mark(k - 1))
    for k, corner in enumerate(corners):
        ax.axvline(corner, color="C0", lw=0.5, alpha=0.6, zorder=0.5)
        ax.annotate(LETTERS[k % len(LETTERS)], (corner, 1.0), (1.5, -4.0 - 7.0 * (k % 2)), va="top", fontsize=7,
                    xycoords=("data", "axes fraction"), textcoords="offset points", color="C0")  # fmt: skip
    modes = any(a.modes for a in found)
    rate = "rate of the guard before" if modes else f"gap velocity after [{own_unit('m/s', labels)}]"
    event = "switch" if modes else "impact"
    ax.set(xlabel="phase of the forcing [periods]", ylabel=rate, xlim=(0.0, 1.0))
    ax.tick_params(labelbottom=True)
    ax.grid(alpha=0.3)
    if len(phase):
        ax.legend(title=f"{event} of the period", fontsize=8, title_fontsize=8, loc="upper left",
                  bbox_to_anchor=(1.0, 1.0), frameon=False)  # fmt: skip


def section_panel(ax: Any, found: Sequence[Any], labels: Sequence[str] = LABELS) -> None:
    """Position and velocity once per period, or the first two states, one colour and one mark an attractor."""
    across = len(labels) // 2
    for k, a in enumerate(found):
        dots(
            ax,
            a.cloud[:, 0],
            a.cloud[:, across],
            f"C{k}",
            FEW if a.periods else MANY,
            f"{a.name}: {a.share:.1%}",
            looks.mark(k),
        )
    ax.set(xlabel=labels[0], ylabel=labels[across])
    ax.tick_params(labelbottom=True)
    ax.grid(alpha=0.3)
    ax.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)


def dots(ax: Any, x: Array, y: Array, colour: Any, size: float, label: str, mark: str = "o") -> None:
    """Points, and a mark of their colour in the legend that can be seen at any size."""
    ax.plot(x, y, mark, color=colour, ms=size, mew=0.0, rasterized=len(x) > 200)
    ax.plot([], [], mark, color=colour, ms=5, label=label)
