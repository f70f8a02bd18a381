"""Figs 5.1 and 5.4: the orbit O(1, 1) of the cam-follower around its corner impact."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from lagrangian import Scene
from lagrangian.scenes import cam_follower
from lcpstep import EventDriven
from lcpstep.analysis.border_collision import PiecewiseLinearMap, classify, diagram
from lcpstep.analysis.corner_branches import orbit_branches
from lcpstep.analysis.corners import CornerImpact, corner_impact, local_map
from lcpstep.analysis.orbits import periodic_orbit
from lcpstep.maps import periods
from lcpstep.plot.corners import diagrams
from lcpstep.plot.orbits import STABLE, UNSTABLE
from lcpstep.thesis.motions import draw_orbit

WIDTH = 0.7  # of the diagrams, either way [rpm]
SETTLED, SHOWN, MOST = 3000, 40, 16
AWAY = 6.0  # where the orbits on both branches are shown [rpm]


def _make(rpm: float) -> Scene:
    return cam_follower(rpm=rpm)


@lru_cache(maxsize=1)
def _impact() -> tuple[CornerImpact, PiecewiseLinearMap]:
    x = periods(_make(700.0), EventDriven(), [0.4, 0.4], 400).final[0]
    orbit = corner_impact(_make, 673.0, x)
    return orbit, local_map(orbit)


def corner_diagrams() -> tuple[Any, dict[str, Any]]:
    """Fig 5.4."""
    orbit, chain = _impact()
    values = orbit.p + np.linspace(-WIDTH, WIDTH, 161)
    local = [orbit.x + y for y in diagram(chain, values - orbit.p, drop=SETTLED, keep=SHOWN)]
    full = [
        periods(
            _make(float(v)), EventDriven(), orbit.x, SETTLED + SHOWN, drop=SETTLED, most=0, strict=False
        ).states[0]
        for v in values
    ]
    branches = orbit_branches(orbit, chain, values)
    words = classify(chain).words
    title = f"cam-follower: corner impact at {orbit.p:.9f} rpm, {words}"
    figure = diagrams(values, local, full, orbit.p, ("rpm", "position on the section [m]"), title, branches)
    data = {"rpm": values, "local": local, "full": full, "branches": [b.as_dict() for b in branches]}
    return figure, data


def around_the_corner() -> tuple[Any, dict[str, Any]]:
    """Fig 5.1: phases of impacts and positions over the speed; both orbits above the corner impact."""
    from matplotlib.figure import Figure

    orbit, chain = _impact()
    values = orbit.p + np.linspace(-AWAY, AWAY, 241)
    runs = [
        periods(
            _make(float(v)), EventDriven(), orbit.x, SETTLED + SHOWN, drop=SETTLED, most=MOST, strict=False
        )
        for v in values
    ]
    full = [run.states[0] for run in runs]
    phases = [
        struck(run.time[0], orbit.scene.period * orbit.p / v) for run, v in zip(runs, values, strict=True)
    ]
    branches = sorted(
        (b for b in orbit_branches(orbit, chain, values) if not b.local), key=lambda b: not b.stable
    )
    figure = Figure(figsize=(12, 14), layout="constrained")
    figure.suptitle(f"cam-follower: O(1, 1) around its corner impact at {orbit.p:.6f} rpm; event-driven")
    grid = figure.add_gridspec(4, 2, width_ratios=[1.6, 1.0])
    upper = figure.add_subplot(grid[0, :])
    lower = figure.add_subplot(grid[1, :], sharex=upper)
    for ax, points in ((upper, phases), (lower, [y[:, 0] for y in full])):
        x = np.concatenate([np.full(len(y), v) for v, y in zip(values, points, strict=True)])
        ax.plot(x, np.concatenate(points), "k.", ms=2.5, mew=0.0, rasterized=True)
        ax.axvline(orbit.p, color="C0", lw=0.8)
        ax.grid(alpha=0.3)
    for b in branches:
        style, label = (STABLE, "stable O(1, 1)") if b.stable else (UNSTABLE, "unstable O(1, 1)")
        lower.plot(b.p, b.x[:, 0], label=label, **style)
    corner = orbit.time / orbit.scene.period % 1.0
    upper.axhline(corner, color="C0", lw=0.8, ls=":", label="the corner b")
    upper.set(ylabel="phase of impacts [periods]", ylim=(0.0, 1.0))
    lower.set(xlabel="cam speed [rpm]", ylabel="position on the section [m]", xlim=(values[0], values[-1]))
    for ax in (upper, lower):
        ax.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)
    data: dict[str, Any] = {
        "rpm": values, "phases": phases, "full": full, "branches": [b.as_dict() for b in branches],
    }  # fmt: skip
    for k, b in enumerate(branches):
        rpm = float(b.p[-1])
        shown = periodic_orbit(_make(rpm), b.x[-1])
        left, right = figure.add_subplot(grid[k + 2, 0]), figure.add_subplot(grid[k + 2, 1])
        draw_orbit(left, right, shown)
        left.set_title(f"{'stable' if b.stable else 'unstable'} {shown.name} at {rpm:.6g} rpm", fontsize=10)
        data[f"orbit at {rpm:g} rpm, {'stable' if b.stable else 'unstable'}"] = shown.x
    return figure, data


def struck(time: Any, period: float) -> Any:
    """Phases of the impacts at these times, (n, most) with not-a-number beyond the last of each period."""
    return (time[np.isfinite(time)] / period) % 1.0
