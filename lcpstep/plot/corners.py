"""Bifurcation diagrams of a corner impact: of the local map and of the full system, side by side.

The layout is that of G. Osorio, Complex Behavior in Impacting Systems, chapter 5.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.analysis.corner_branches import FixedBranch
from lcpstep.plot.orbits import STABLE, UNSTABLE
from lcpstep.plot.words import parameter_label

Array = NDArray[np.float64]


def diagrams(
    values: Array, local: Sequence[Array], full: Sequence[Array], p: float, names: tuple[str, str], title: str,
    branches: Sequence[FixedBranch] = (),
) -> Any:  # fmt: skip
    """Points of both maps over the parameter.

    Parameters
    ----------
    values : (k,) parameters;  local, full : for each of them points (n, d) of the two maps, in absolute coordinates
    p : parameter of the corner impact, drawn as a line
    names : of the parameter and of the first coordinate, with their units
    branches : of fixed points, drawn solid where they are stable and dashed where not
    """
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(11, 4.5), layout="constrained")
    figure.suptitle(title)
    axes = figure.subplots(1, 2, sharex=True, sharey=True)
    for ax, points, name in zip(axes, (local, full), ("local map", "full system"), strict=True):
        x = np.concatenate([np.full(len(y), v) for v, y in zip(values, points, strict=True)])
        y = np.concatenate([y[:, 0] for y in points])
        ax.plot(x, y, "k.", ms=2.5, mew=0.0, rasterized=True)
        for branch in branches:
            if branch.local == (name == "local map"):
                style = STABLE if branch.stable else UNSTABLE
                label = "stable orbit" if branch.stable else "unstable orbit"
                ax.plot(branch.p, branch.x[:, 0], label=label, **style)
        ax.axvline(p, color="C0", lw=0.8)
        ax.set(title=name, xlabel=parameter_label(names[0]), xlim=(values[0], values[-1]))
        if branches:
            ax.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)
            ax.title.set(x=0.0, ha="left")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel(names[1])
    shown = np.concatenate([y[:, 0] for y in full] + [local[int(np.argmin(np.abs(values - p)))][:, 0]])
    margin = 0.1 * max(float(np.ptp(shown)), 1e-300)
    axes[0].set_ylim(np.min(shown) - margin, np.max(shown) + margin)  # the local map knows no far obstacle
    return figure
