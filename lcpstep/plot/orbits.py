"""Pictures of periodic orbits: branches over a parameter, multipliers in the complex plane, the motion itself.

The contents are those of G. Osorio, Complex Behavior in Impacting Systems, Figs 4.10, 4.13, 5.1 and 5.4.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, checks
from lcpstep.analysis.orbits import PeriodicOrbit
from lcpstep.plot import looks
from lcpstep.plot.lift import absolute
from lcpstep.plot.words import names_of, parameter_label
from lcpstep.trajectory import blows

Array = NDArray[np.float64]
SAMPLES = 2000
STABLE: dict[str, Any] = {"color": "k", "ls": "-", "lw": 1.5}
UNSTABLE: dict[str, Any] = {"color": "C3", "ls": "--", "lw": 1.3}
MARKS = {
    "corner": "D",
    "flip": "o",
    "fold": "s",
    "grazing": "^",
    "jump": "x",
    "torus": "P",
    "branch point": "v",
}


def branch(data: Any, title: str = "") -> Any:
    """Figure of a branch dataset: position on the section, moduli of the multipliers, and their path in the plane."""
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.branch_data")
    from lcpstep.plot.figures import Figure

    parameter = str(data.attrs["parameter"])
    figure = Figure(figsize=(11, 10), layout="constrained")
    figure.suptitle(title)
    grid = figure.add_gridspec(3, 1, height_ratios=[1.0, 0.8, 1.0])
    above = figure.add_subplot(grid[0])
    below = figure.add_subplot(grid[1], sharex=above)
    branch_lines(above, data)
    mark_special(above, data)
    above.set(ylabel=f"{data.attrs['labels'][0]}\nat phase {data.attrs['phase']:.4g}")
    # Above the axes: beside them it would take its width from the colour bar's column too
    above.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=6, frameon=False)
    p, stable = data[parameter].values, data["stable"].values.astype(bool)
    for which, style, filled in ((stable, STABLE, True), (~stable, UNSTABLE, False)):
        for modulus in data["multiplier_modulus"].values[which].T:
            below.plot(p[which], modulus, "o", ms=2.5, color=style["color"], mfc=None if filled else "none")
    below.axhline(1.0, color="0.5", lw=0.8)
    below.set(
        ylabel="modulus of the multipliers", xlabel=parameter_label(parameter), xlim=data.attrs["range"]
    )
    for ax in (above, below):
        ax.grid(alpha=0.3)
    multiplier_plane(figure, figure.add_subplot(grid[2]), data)
    return figure


def branch_lines(ax: Any, data: Any, coordinate: int = 0) -> None:
    """The branch, solid where it is stable and dashed where not, changing exactly at its special points."""
    named: set[bool] = set()
    for p, x, stable in stretches(data):
        label = {True: "stable", False: "unstable"}[stable] if stable not in named else None
        named.add(stable)
        ax.plot(p, x[:, coordinate], label=label, **(STABLE if stable else UNSTABLE))


def stretches(data: Any) -> list[tuple[Array, Array, bool]]:
    """Parts of a branch that are stable or unstable throughout: parameter, states, and which of the two."""
    p, x = data[str(data.attrs["parameter"])].values, data["x"].values
    stable = data["stable"].values.astype(bool)
    places = {int(k): i for i, k in enumerate(data["special_after"].values) if 0 <= k < len(p) - 1}
    result: list[tuple[Array, Array, bool]] = []
    ps, xs = [p[0]], [x[0]]
    for k in range(len(p) - 1):
        if stable[k + 1] != stable[k]:
            at = places.get(k)
            border = (p[k + 1], x[k + 1]) if at is None else (
                data["special_p"].values[at], data["special_x"].values[at]
            )  # fmt: skip
            ps.append(border[0])
            xs.append(border[1])
            result.append((np.array(ps), np.array(xs), bool(stable[k])))
            ps, xs = [border[0]], [border[1]]
        ps.append(p[k + 1])
        xs.append(x[k + 1])
    return [*result, (np.array(ps), np.array(xs), bool(stable[-1]))]


def mark_special(ax: Any, data: Any, coordinate: int = 0) -> None:
    """Special points, each kind with a mark of its own."""
    for kind in dict.fromkeys(str(k) for k in data["special_kind"].values):
        which = data["special_kind"].values == kind
        p, x = data["special_p"].values[which], data["special_x"].values[which, coordinate]
        label = f"{kind}: {', '.join(f'{value:.7g}' for value in p)}"
        ax.plot(p, x, MARKS.get(kind, "o"), color="C0", ms=6, label=label)


def multiplier_plane(figure: Any, ax: Any, data: Any) -> None:
    """Path of the multipliers in the complex plane, coloured by the parameter, with the unit circle."""
    parameter = str(data.attrs["parameter"])
    angle = np.linspace(0.0, 2.0 * np.pi, 400)
    ax.plot(np.cos(angle), np.sin(angle), color="0.5", lw=0.8)
    ax.axhline(0.0, color="0.8", lw=0.6, zorder=0)
    ax.axvline(0.0, color="0.8", lw=0.6, zorder=0)
    real, imag = data["multiplier_real"].values, data["multiplier_imag"].values
    p = np.broadcast_to(data[parameter].values[:, None], real.shape)
    points = ax.scatter(real, imag, c=p, s=12, cmap="viridis", zorder=3)
    figure.colorbar(points, ax=ax, label=parameter_label(parameter), pad=0.01)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set(xlabel="real part of the multipliers", ylabel="imaginary part")


def orbit(found: PeriodicOrbit, title: str = "") -> Any:
    """The motion over its period with what it strikes, and in the state plane (of its first coordinate)."""
    checks.instance("found", found, PeriodicOrbit)
    from lcpstep.plot.figures import Figure

    T, n = found.scene.period, found.periods
    start = found.phase * T
    run = found.run()
    modes = isinstance(found.scene, HybridScene)
    jumps = (run.switches if modes else blows(run.impacts)).time
    t = np.unique(
        np.concatenate([np.linspace(start, start + n * T, SAMPLES * n), jumps, np.nextafter(jumps, start)])
    )
    across = found.scene.n_x // 2
    x = run.at(t) if modes else np.concatenate(run.at(t), axis=1)
    figure = Figure(figsize=(12, 4.5), layout="constrained")
    figure.suptitle(title)
    left, right = figure.subplots(1, 2, width_ratios=[1.6, 1.0])
    if isinstance(found.scene, HybridScene):
        modes_panel(left, found.scene, t, x, run.mode_at(t))
    else:
        motion_panel(left, found.scene, t, x[:, :across], x[:, across:])
    for time in jumps:
        left.axvline(time / T, color="0.85", lw=0.8, zorder=0)
    state_panel(right, found.scene, t, x[:, 0], x[:, across], jumps)
    right.plot(found.x[:, 0], found.x[:, across], "C3o", ms=4, label=f"section at phase {found.phase:.4g}")
    right.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


def motion_panel(ax: Any, scene: Any, t: Array, q: Array, v: Array) -> None:
    """Position over time in periods, with the obstacle where there is one coordinate and one contact."""
    position, surface = absolute(scene, t, q, v)
    body, obstacle = names_of(scene)
    labels = scene.labels[: scene.n_q]
    for k, x in enumerate(position.T):
        ax.plot(t / scene.period, x, **looks.line(k), label=body if scene.n_q == 1 else labels[k])
    if surface is not None:
        ax.plot(t / scene.period, surface, "k--", lw=1.0, label=obstacle)
    if surface is not None or scene.n_q > 1:
        _legend_above(ax)
    ax.set(xlabel="time [periods]", ylabel=labels[0] if scene.n_q == 1 else "position",
           xlim=(t[0] / scene.period, t[-1] / scene.period))  # fmt: skip
    ax.grid(alpha=0.3)


def modes_panel(ax: Any, scene: HybridScene, t: Array, x: Array, mode: Any) -> None:
    """The first state over time in periods, one colour and dashes of its own a mode."""
    ends = np.flatnonzero(mode[1:] != mode[:-1]) + 1
    names = list(dict.fromkeys(str(name) for name in mode))
    shown: set[str] = set()
    for piece in np.split(np.arange(len(t)), ends):
        name, to = str(mode[piece[0]]), slice(piece[0], piece[-1] + 2)
        label = None if name in shown else name
        ax.plot(t[to] / scene.period, x[to, 0], **looks.line(names.index(name)), label=label)
        shown.add(name)
    _legend_above(ax)
    ax.set(xlabel="time [periods]", ylabel=scene.labels[0], xlim=(t[0] / scene.period, t[-1] / scene.period))
    ax.grid(alpha=0.3)


def _legend_above(ax: Any) -> None:
    """Names above the axes, where they cover no curve."""
    ax.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=4, frameon=False)


def state_panel(ax: Any, scene: Any, t: Array, q: Array, v: Array, jumps: Array) -> None:
    """The path in the plane of position and velocity, its jumps in grey."""
    landed = np.searchsorted(t, jumps)
    landed = landed[(landed > 0) & (landed < len(t))]
    ax.plot([q[landed - 1], q[landed]], [v[landed - 1], v[landed]], color="0.7", lw=0.8)
    ax.plot(np.insert(q, landed, np.nan), np.insert(v, landed, np.nan), "C0-", lw=1.2)
    ax.set(xlabel=scene.labels[0], ylabel=scene.labels[scene.n_x // 2])
    ax.grid(alpha=0.3)
