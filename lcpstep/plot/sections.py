"""Impact and stroboscopic maps of two runs, side by side.

The layout is that of G. Osorio, Complex Behavior in Impacting Systems, Fig 3.6.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from lcpstep.maps import Sections

TWO_PI = 2.0 * math.pi


def maps(points: Mapping[str, Sections], title: str, angle_at_start: float = 0.0, lowest: float = 0.0) -> Any:
    """One row a method: impacts (angle of the forcing, velocity after) and states once per period.

    The angle is angle_at_start at t = 0 and is shown within [lowest, lowest + 2 pi) [rad].
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 4.0 * len(points)), layout="constrained")
    figure.suptitle(title)
    grid = figure.subplots(len(points), 2, sharex="col", sharey="col", squeeze=False)
    for (left, right), (name, p) in zip(grid, points.items(), strict=True):
        angle = lowest + (TWO_PI * p.phase + angle_at_start - lowest) % TWO_PI
        left.plot(angle, p.after, "k.", ms=1.5)
        left.set(title=f"impact map: {name}", ylabel="gap velocity after impact [m/s]")
        right.plot(p.q[:, 0], p.v[:, 0], "k.", ms=1.5)
        right.set(title=f"stroboscopic map: {name}", ylabel="velocity [m/s]")
        for ax in (left, right):
            ax.grid(alpha=0.3)
    grid[-1][0].set_xlabel("angle of the forcing at impact [rad]")
    grid[-1][1].set_xlabel("position [m]")
    return figure
