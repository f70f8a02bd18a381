"""Several methods on one scene: the motion, how far each is from the reference, and what accuracy costs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from lagrangian import checks
from lcpstep.accuracy.contest import Contest
from lcpstep.plot.work_precision import whole_decades

# Lines and marks tell them apart without colours
LOOKS = (
    ("C1", "--", "o"),
    ("C0", "-", "s"),
    ("C2", "-.", "D"),
    ("C3", ":", "^"),
    ("C4", "-", "v"),
    ("C5", "--", "P"),
)
LOWEST = 1e-16  # distance that is drawn
WIDTH, HEIGHT = 12.5, 3.6  # of the picture, and of each scene [inch]


def contests(found: Sequence[Contest], titles: Sequence[str]) -> Any:
    """A row for each scene: motion above the distances from the reference, and a work-precision diagram beside."""
    checks.filled("found", found, Sequence, "a list of Contest")
    for one in found:
        checks.instance("found", one, Contest)
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(WIDTH, HEIGHT * len(found) + 0.4), layout="constrained")
    grid = figure.add_gridspec(
        2 * len(found), 2, width_ratios=[1.9, 1.0], height_ratios=[1.5, 1.0] * len(found)
    )
    for k, (one, title) in enumerate(zip(found, titles, strict=True)):
        motion = figure.add_subplot(grid[2 * k, 0])
        distance = figure.add_subplot(grid[2 * k + 1, 0], sharex=motion)
        cost = figure.add_subplot(grid[2 * k : 2 * k + 2, 1])
        motion.set_title(title, loc="left")
        _motion(motion, distance, one)
        _cost(cost, one)
    handles: dict[str, Any] = {}
    for ax in figure.axes:
        for handle, name in zip(*ax.get_legend_handles_labels(), strict=True):
            handles.setdefault(name, handle)
    names = sorted(handles, key=lambda name: name != "reference")
    figure.legend(
        [handles[n] for n in names],
        names,
        loc="outside upper center",
        ncols=min(len(names), 5),
        frameon=False,
    )
    return figure


def _motion(motion: Any, distance: Any, one: Contest) -> None:
    """First coordinate over time, and how far away each method is."""
    motion.plot(one.t, one.q[:, 0], color="0.75", lw=3.5, label="reference")
    for entrant, (colour, style, mark) in zip(one.entrants, LOOKS * len(one.entrants), strict=False):
        if entrant.run is not None:
            look: dict[str, Any] = {"color": colour, "ls": style, "lw": 1.0}
            motion.plot(entrant.run.t, entrant.run.q[:, 0], **look)
            distance.semilogy(entrant.run.t, np.maximum(entrant.apart, LOWEST), **look)
            distance.plot([], [], marker=mark, label=entrant.name, **look)
    motion.set_ylabel(one.scene.labels[0])
    motion.tick_params(labelbottom=False)
    distance.set(xlabel="time t [s]", ylabel=f"|q - q_ref| [{one.unit}]", xlim=(one.t[0], one.t[-1]))
    for ax in (motion, distance):
        ax.grid(alpha=0.3)


def _cost(ax: Any, one: Contest) -> None:
    """Error over CPU time of every level, on logarithmic scales."""
    for entrant, (colour, style, mark) in zip(one.entrants, LOOKS * len(one.entrants), strict=False):
        levels = [x for x in entrant.levels if x.error > 0.0]
        ax.plot(
            [x.seconds for x in levels], [x.error for x in levels], marker=mark, ms=4, color=colour, ls=style
        )
    ax.set(xscale="log", yscale="log", xlabel="CPU time [s]", ylabel=f"largest error [{one.unit}]")
    whole_decades(ax)
    ax.grid(alpha=0.3)
