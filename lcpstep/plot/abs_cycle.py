"""The hybrid anti-lock controller in one picture: cycle, time series, bifurcation over the torque threshold, basins.

The content is that of the figures of G. Osorio, Complex Behavior in Impacting Systems, chapter 7.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian.hybrid import HybridScene
from lagrangian.scenes.hybrid_abs import T_MAX, holding_torque
from lcpstep.analysis.abs_basins import Basins
from lcpstep.analysis.abs_cycle import OUTCOMES, Cycle, corner, peak
from lcpstep.analysis.abs_parameters import Bifurcation
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.simulation import simulate

COLOURS = ("#bfe6c6", "#e3827c", "#4468ad", "#202020")  # of the outcomes; light to dark, for a copy in grey


def overview(
    scene: HybridScene, cycle: Cycle | None, over: Bifurcation | None, found: Basins | None, title: str
) -> Any:
    """What has been computed; panels of what has not stay empty."""
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(15, 8), layout="constrained")
    figure.suptitle(title)
    axes = figure.subplots(2, 4)
    _plane(axes[0, 0], scene, cycle)
    _series(axes[0, 1], scene, cycle)
    _over(axes[0, 2], axes[0, 3], scene, over)
    for q in range(4):
        _basin(axes[1, q], scene, cycle, found, q)
    return figure


def _isocline(ax: Any, scene: HybridScene) -> None:
    slip = np.linspace(0.0, 1.0, 400)
    ax.plot(slip, [holding_torque(s, scene.p) for s in slip], "k--", lw=0.8, label="isocline T = Ψ(λ)")


def _orbit(ax: Any, scene: HybridScene, cycle: Cycle, **style: Any) -> None:
    run = simulate(scene.started(corner(scene), "2", (0.0, cycle.period)), EventDriven())
    x = run.at(np.linspace(0.0, cycle.period, 2000))
    ax.plot(x[:, 0], x[:, 1], **style)


def _plane(ax: Any, scene: HybridScene, cycle: Cycle | None) -> None:
    _isocline(ax, scene)
    if cycle is not None:
        _orbit(ax, scene, cycle, color="C0", label="limit cycle")
        ax.plot(cycle.slip, cycle.torque, "ko", ms=4)
        for state, s, T in zip(cycle.states, cycle.slip, cycle.torque, strict=True):
            ax.annotate(state, (s, T), (3.0, 4.0), textcoords="offset points", fontsize=9)
    ax.set(xlabel="slip λ [-]", ylabel="brake torque T [N m]", xlim=(0.0, 1.0))
    ax.set_ylim(0.0, 1.15 * float(np.asarray(scene.p)[T_MAX]))
    _above(ax, "")
    ax.grid(alpha=0.3)


def _series(ax: Any, scene: HybridScene, cycle: Cycle | None) -> None:
    if cycle is not None:
        end = 2.0 * cycle.period
        t = np.linspace(0.0, end, 2000)
        x = simulate(scene.started(corner(scene), "2", (0.0, end)), EventDriven()).at(t)
        ax.plot(t, x[:, 0], "C0-", label="λ [-]")
        ax.plot(t, x[:, 1] / 1e4, "C3--", label="T [10 kN m]")
    ax.set(xlabel="time [s]", xlim=(0.0, None))
    _above(ax, "two periods")
    ax.grid(alpha=0.3)


def _over(left: Any, right: Any, scene: HybridScene, over: Bifurcation | None) -> None:
    for ax in (left, right):
        ax.axvline(peak(scene)[1], color="k", ls="--", lw=0.8, label="max Ψ")
        ax.set_xlabel("T_max [N m]")
        ax.grid(alpha=0.3)
    if over is not None:
        left.plot(over.torque_max, over.period, "C0.-", ms=3)
        right.plot(over.torque_max, over.slip_low, "C0-", label="smallest λ")
        right.plot(over.torque_max, over.slip_high, "C3-.", label="largest λ")
    left.set(ylabel="period [s]", ylim=(0.0, None))
    right.set(ylabel="slip λ [-]")
    _above(left, "")
    _above(right, "")


def _above(ax: Any, title: str) -> None:
    """Title and legend above the axes, side by side."""
    ax.set_title(title, loc="left", fontsize=9)
    ax.legend(
        fontsize=7, loc="lower right", bbox_to_anchor=(1.02, 0.99), ncols=3, frameon=False, columnspacing=0.8
    )


def _basin(ax: Any, scene: HybridScene, cycle: Cycle | None, found: Basins | None, q: int) -> None:
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    if found is not None:
        ax.pcolormesh(
            found.slip, found.torque, np.where(found.labels[q] < 0, np.nan, found.labels[q]).T,
            cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=3.5, shading="nearest",
        )  # fmt: skip
    _isocline(ax, scene)
    if cycle is not None:
        _orbit(ax, scene, cycle, color="k", lw=0.8)
    ax.set(xlabel="slip λ [-]", ylabel="brake torque T [N m]")
    ax.set_title(f"basin of state {q}", loc="left", fontsize=9)
    if q == 0 and found is not None:
        seen = [k for k in range(len(OUTCOMES)) if np.any(found.labels == k)]
        handles = [Patch(color=COLOURS[k], label=OUTCOMES[k]) for k in seen]
        ax.figure.legend(handles=handles, fontsize=8, loc="outside lower center", ncols=len(seen))


def stopping(run: HybridTrajectory, title: str) -> Any:
    """Slip, torque and the speeds of car and wheel over one stop."""
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(10, 7), layout="constrained")
    slip, torque, speed = figure.subplots(3, 1, sharex=True)
    t = np.linspace(run.pieces.t[0], run.switches.time[-1] if len(run.switches) else run.pieces.t[-1], 4000)
    x = run.at(t)
    slip.plot(t, x[:, 0], lw=1.0)
    torque.plot(t, x[:, 1], "C3-", lw=1.0)
    speed.plot(t, x[:, 2], "k-", lw=1.2, label="car")
    speed.plot(t, x[:, 2] * (1.0 - x[:, 0]), "C0--", lw=1.0, label="rim of the wheel")
    speed.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8, frameon=False)
    for ax, label in zip((slip, torque, speed), ("slip [-]", "torque [N m]", "speed [m/s]"), strict=True):
        ax.set_ylabel(label)
        ax.grid(alpha=0.3)
    speed.set_xlabel("time [s]")
    slip.set_title(title)
    return figure
