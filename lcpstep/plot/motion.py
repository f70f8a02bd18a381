"""Time series and state-space portraits of two runs of one scene, side by side.

The layout is that of G. Osorio, Complex Behavior in Impacting Systems, Figs 3.4 and 3.5.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.labels import common_unit, own_unit
from lcpstep.accuracy.compare import Comparison
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.plot import looks
from lcpstep.plot.words import method_words
from lcpstep.trajectory import Trajectory, blows

SAMPLES = 4000  # of a curve
MOMENT = 1e-12  # of a span: more than rounding makes of the time of an impact
DECADES = 1e-5  # how far below its maximum the distance of two motions is drawn
JUMPS = "0.75"  # colour of the velocity jumps
BAND = 0.3  # how much the band of an error bar covers
NAMED = 8  # curves that a legend names
QUANTITIES = {"rad": ("angle", "angular velocity")}  # what positions and velocities are called, by unit


def time_series(comparisons: Sequence[Comparison], titles: Sequence[str]) -> Any:
    """Positions of both runs overlaid, and below each the distance of the two on a logarithmic scale."""
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(11, 3.4 * len(comparisons)), layout="constrained")
    axes = figure.subplots(2 * len(comparisons), 1, height_ratios=[3, 1] * len(comparisons), squeeze=False)[
        :, 0
    ]
    for k, (c, title) in enumerate(zip(comparisons, titles, strict=True)):
        fast, exact, distance = c.fast.trajectory, c.reference.trajectory, axes[2 * k + 1]
        t = np.linspace(exact.t[0], exact.t[-1], SAMPLES)
        axes[2 * k].plot(t, exact.at(t)[0][:, 0], "k-", lw=1.8, label=method_words(exact.method))
        axes[2 * k].plot(fast.t, fast.q[:, 0], "C1--", lw=1.1, label=method_words(fast.method))
        axes[2 * k].set(title=title, ylabel=exact.scene.labels[0])
        axes[2 * k].legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, fontsize=8, frameon=False)
        axes[2 * k].title.set(x=0.0, ha="left")
        distance.semilogy(fast.t[: len(c.difference)], np.abs(c.difference[:, 0]), "C3-", lw=0.7)
        unit = common_unit(exact.scene.labels[:1])
        distance.set(ylabel=f"|Δq| [{unit}]" if unit else "|Δq|", xlabel="time t [s]")
        distance.set_ylim(bottom=max(c.sup_q, 1e-16) * DECADES)
        for ax in (axes[2 * k], distance):
            ax.set_xlim(exact.t[0], exact.t[-1])
            ax.grid(alpha=0.3)
    return figure


def portraits(comparisons: Sequence[Comparison], titles: Sequence[str]) -> Any:
    """State-space portraits, one row a comparison: the fast method on the left, the reference on the right."""
    from lcpstep.plot.figures import Figure

    figure = Figure(figsize=(10, 3.6 * len(comparisons)), layout="constrained")
    grid = figure.subplots(len(comparisons), 2, sharex="row", sharey="row", squeeze=False)
    for row, c, title in zip(grid, comparisons, titles, strict=True):
        for ax, run in zip(row, (c.fast.trajectory, c.reference.trajectory), strict=True):
            portrait(ax, run)
            labels = run.scene.labels
            ax.set(title=f"{title}: {method_words(run.method)}", xlabel=labels[0])
        row[0].set_ylabel(labels[len(labels) // 2])
    return figure


def portrait(ax: Any, run: Trajectory, coordinate: int = 0) -> None:
    """One coordinate's path in the plane (q, v); velocity jumps in grey."""
    checks.has("ax", ax, "plot", "axes of matplotlib")
    checks.instance("run", run, Trajectory)
    jumps = blows(run.impacts).time
    t = _times(run.t, jumps)
    q, v = (x[:, coordinate] for x in run.at(t))
    # The path is broken where it jumps, and the jump drawn as a line of its own.
    landed = np.flatnonzero(np.isin(t, jumps))
    landed = landed[landed > 0]
    ax.plot([q[landed - 1], q[landed]], [v[landed - 1], v[landed]], color=JUMPS, lw=0.6)
    ax.plot(np.insert(q, landed, np.nan), np.insert(v, landed, np.nan), "C0-", lw=0.7)
    ax.grid(alpha=0.3)


def overview(run: Trajectory | HybridTrajectory) -> Any:
    """Position, velocity and impulses of one run over time; of a system with modes, its states and its mode.

    The error bar of a run that has one is a band around positions and velocities: the largest error until then.
    """
    checks.instance("run", run, Trajectory, HybridTrajectory)
    from lcpstep.plot.figures import Figure

    if isinstance(run, HybridTrajectory):
        return _states_and_mode(run)
    figure = Figure(figsize=(10, 7), layout="constrained")
    position, velocity, impulse = figure.subplots(3, 1, sharex=True)
    t, states, look = _curves(run)
    n, labels = run.scene.n_q, run.scene.labels
    for which, (ax, x, own) in enumerate(
        zip((position, velocity), states, (labels[:n], labels[n:]), strict=True)
    ):
        for k, values in enumerate(x.T):
            ax.plot(t, values, **look(k))
        unit = common_unit(own)
        what = QUANTITIES.get(common_unit(labels[:n]), ("position", "velocity"))[which]
        ax.set_ylabel(own[0] if n == 1 else f"{what} [{unit}]" if unit else what)
        if n > 1 and not (which and unit):  # velocities look as their positions, and have units of their own
            _legend(ax, ax.get_lines(), [x.partition(" [")[0] for x in own] if unit else own)
    if run.error is not None:
        for ax, which, bar in ((position, 0, run.error.position), (velocity, 1, run.error.velocity)):
            band(ax, run, which, bar)
    _impulses(impulse, run)
    for ax in (position, velocity, impulse):
        ax.grid(alpha=0.3)
    impulse.set_xlabel("time t [s]")
    position.set_title(f"{run.scene.name}: {method_words(run.method)}")
    return figure


def band(ax: Any, run: Trajectory, which: int, bar: Any) -> None:
    """Positions (0) or velocities (1) of a run with an error bar, as far as it holds, give or take the error."""
    known = run.error.t
    t = np.unique(np.concatenate([known, run.t[run.t <= known[-1]]]))
    x = run.at(t)[which]
    for k, (values, errors) in enumerate(zip(x.T, bar.largest.T, strict=True)):
        e = np.interp(t, known, errors)
        ax.fill_between(t, values - e, values + e, color=f"C{k % 10}", alpha=BAND, lw=0.0)
    if run.error.reason:
        ax.axvline(run.error.until, color="0.5", lw=0.8, ls=":")


def _times(known: Any, jumps: Any) -> Any:
    """Times close to each other, those of the kept states, and of each jump a moment before it and its own."""
    if len(known) == 0:
        return known
    start, end = known[0], known[-1]
    jumps = jumps[(jumps > start) & (jumps <= end)]
    before = np.minimum(np.nextafter(jumps, start), jumps - MOMENT * (end - start))
    sides = jumps, np.maximum(before, start)
    return np.unique(np.concatenate([np.linspace(start, end, SAMPLES), known, *sides]))


def _curves(run: Trajectory | HybridTrajectory) -> tuple[Any, Any, Callable[[int], dict[str, Any]]]:
    """Times, states at them, and looks: lines, or marks of the kept states where none are known in between."""
    modes = isinstance(run, HybridTrajectory)
    logs = [log.time for log in (run.impacts, run.switches if modes else None) if log is not None]
    try:
        t = _times(run.pieces.t if modes else run.t, np.concatenate(logs))
        return t, run.at(t), looks.line
    except ValueError:  # what `at` raises between states of which some were not kept
        return run.t, run.x if modes else (run.q, run.v), looks.points


def _impulses(ax: Any, run: Trajectory | HybridTrajectory) -> None:
    """The impulse of every impact, one colour a contact."""
    jumps = blows(run.impacts)
    stems = []
    for contact in np.unique(jumps.contact):
        own = jumps[jumps.contact == contact]
        colour, mark = f"C{contact % 10}", looks.mark(contact)
        stem = ax.stem(own.time, own.impulse, linefmt=f"{colour}-", markerfmt=colour + mark, basefmt="none")
        stem.markerline.set_markersize(4.0)
        stem.stemlines.set_linewidth(1.0)
        stems.append(stem.markerline)
    if stems:
        ax.axhline(0.0, color="0.3", lw=0.6)
    else:
        ax.text(0.5, 0.5, "no impacts", ha="center", va="center", transform=ax.transAxes)
        ax.set_yticks([])
    if run.scene.n_c > 1:
        _legend(ax, stems, [f"contact {c}" for c in np.unique(jumps.contact)])
    unit = own_unit("N s", run.scene.labels)
    ax.set_ylabel(f"impulse [{unit}]" if unit else "impulse")


def _legend(ax: Any, handles: Any, names: Sequence[str]) -> None:
    """Names beside the curves; of many, the first."""
    shown = list(names[:NAMED])
    if len(names) > NAMED:
        shown[-1] += f", and {len(names) - NAMED} more"
    if shown:
        ax.legend(
            list(handles)[:NAMED],
            shown,
            loc="upper left",
            bbox_to_anchor=(1.01, 1.0),
            fontsize=8,
            frameon=False,
        )


def _states_and_mode(run: HybridTrajectory) -> Any:
    """One panel a state, one of impulses where there are contacts, and the mode as steps."""
    from lcpstep.plot.figures import Figure

    n, names, met = run.scene.n_x, run.scene.system.names, run.impacts is not None
    figure = Figure(figsize=(10, 1.0 + 2.1 * (n + 1 + met)), layout="constrained")
    axes = figure.subplots(n + 1 + met, 1, sharex=True)
    t, x, look = _curves(run)
    for ax, values, label in zip(axes, x.T, run.scene.labels, strict=False):
        ax.plot(t, values, **look(0))
        ax.set_ylabel(label)
    if met:
        _impulses(axes[n], run)
    t = np.unique(np.concatenate([run.pieces.t[[0, -1]], run.switches.time]))
    modes = run.mode_at(t)
    seen = [name for name in names if name in set(modes.tolist())]
    axes[-1].step(t, [seen.index(str(name)) for name in modes], where="post", lw=1.0)
    axes[-1].set(yticks=range(len(seen)), yticklabels=seen, ylabel="mode", xlabel="time t [s]")
    for ax in axes:
        ax.grid(alpha=0.3)
    axes[0].set_title(f"{run.scene.name}: {method_words(run.method)}")
    return figure
