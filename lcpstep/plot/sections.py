"""Impact and stroboscopic maps of two runs, side by side.

The layout is that of G. Osorio, Complex Behavior in Impacting Systems, Fig 3.6.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from lagrangian import checks
from lagrangian.labels import own_unit
from lcpstep.maps import Sections


def maps(
    points: Mapping[str, Sections], title: str, lowest: float = 0.0, corners: Sequence[float] = ()
) -> Any:
    """One row a method: impacts (phase of the forcing, velocity after) and states once per period.

    Parameters
    ----------
    lowest : where the circle of phases is cut: they are shown within [lowest, lowest + 1), in periods
    corners : phases of the corners of the forcing
    """
    checks.filled("points", points, Mapping, "Sections by name")
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(11, 4.0 * len(points)), layout="constrained")
    figure.suptitle(title)
    grid = figure.subplots(len(points), 2, sharex="col", sharey="col", squeeze=False)
    for (left, right), (name, p) in zip(grid, points.items(), strict=True):
        left.plot(lowest + (p.phase - lowest) % 1.0, p.after, "k.", ms=3.0, mew=0.0, rasterized=True)
        left.set(title=f"impact map: {name}", xlim=(lowest, lowest + 1.0))
        left.set_ylabel(f"gap velocity after [{own_unit('m/s', p.labels)}]")
        right.plot(p.q[:, 0], p.v[:, 0], "k.", ms=3.0, mew=0.0, rasterized=True)
        right.set(title=f"stroboscopic map: {name}", ylabel=p.labels[len(p.labels) // 2])
        for corner in corners:
            left.axvline(lowest + (corner - lowest) % 1.0, color="C0", lw=0.5, alpha=0.6, zorder=0.5)
        for ax in (left, right):
            ax.grid(alpha=0.3)
    grid[-1][0].set_xlabel("phase of the forcing at impact [periods]")
    grid[-1][1].set_xlabel(p.labels[0])
    return figure
