"""Pictures of studies: bifurcation diagrams, basins, attractors, branches of periodic orbits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

DPI = 150
COLOURS = "tab20"


def bifurcation(data: Any, title: str = "") -> Any:
    """Figure of a bifurcation dataset: stroboscopic section above, phases of the impacts below."""
    from matplotlib.figure import Figure

    parameter = str(data.attrs["parameter"])
    figure = Figure(figsize=(11, 8), layout="constrained")
    figure.suptitle(title or f"{data.attrs['scene']}: {data.attrs['start']} starts")
    above, below = figure.subplots(2, 1, sharex=True)
    _points(above, below, data, "k", 1.0)
    above.set(ylabel="velocity on the section [m/s]")
    below.set(ylabel="phase of impacts [periods]", xlabel=parameter)
    return figure


def overlaid(reference: Any, others: Mapping[str, Any], apart: Mapping[str, Any], title: str = "") -> Any:
    """Figure of one bifurcation diagram in black and others, by name, over it; below, how far each is from it.

    apart : of each other one, by the same names, from `lcpstep.analysis.agreement.agreement`
    """
    from matplotlib.figure import Figure

    parameter = str(reference.attrs["parameter"])
    figure = Figure(figsize=(11, 12), layout="constrained")
    figure.suptitle(title or f"{reference.attrs['scene']}: {reference.attrs['start']} starts")
    above, below, distance = figure.subplots(3, 1, sharex=True)
    for k, (name, data) in enumerate(others.items()):
        _points(above, below, data, f"C{k}", 2.5)
        distance.semilogy(
            reference[parameter].values, apart[name]["phase_distance"].values, f"C{k}.-", label=name
        )
    _points(above, below, reference, "k", 0.8)
    distance.semilogy([], [], "k.", label="reference")
    above.set(ylabel="velocity on the section [m/s]")
    below.set(ylabel="phase of impacts [periods]")
    distance.set(ylabel="distance of the phases [periods]", xlabel=parameter)
    distance.legend()
    return figure


def _points(above: Any, below: Any, data: Any, colour: str, size: float) -> None:
    """Points of a bifurcation dataset: velocities on the section above, phases of impacts below."""
    values = data[str(data.attrs["parameter"])].values
    v = data["v"].isel(coordinate=0).values  # (run, value, period)
    phase = data["impact_phase"].values
    style = {"color": colour, "marker": ".", "ls": "", "ms": size, "alpha": 0.6}
    above.plot(np.broadcast_to(values[None, :, None], v.shape).ravel(), v.ravel(), **style)
    below.plot(np.broadcast_to(values[None, :, None, None], phase.shape).ravel(), phase.ravel(), **style)


def basins(data: Any, title: str = "") -> Any:
    """Figure of a basin dataset: one colour an attractor, white for none, grey for the obstacle."""
    from matplotlib import colormaps
    from matplotlib.figure import Figure

    label = data["label"].values
    shades = np.array([(0.6, 0.6, 0.6), (1.0, 1.0, 1.0), *colormaps[COLOURS](np.arange(20))[:, :3]])
    figure = Figure(figsize=(9, 7), layout="constrained")
    ax = figure.subplots()
    q, v = data["q"].values, data["v"].values
    extent = (q[0], q[-1], v[0], v[-1])
    ax.imshow(shades[np.minimum(label + 2, len(shades) - 1)], origin="lower", aspect="auto", extent=extent)
    shares = zip(data["name"].values, data["share"].values, data["share_error"].values, strict=True)
    for k, (name, share, error) in enumerate(shares):
        ax.plot(
            [], [], "s", color=shades[min(k + 2, len(shades) - 1)], label=f"{name}: {share:.4f} ± {error:.4f}"
        )
    ax.legend(loc="upper right")
    ax.set(title=title, xlabel="position [m]", ylabel="velocity [m/s]")
    return figure


def attractors(found: Sequence[Any], title: str = "") -> Any:
    """Figure of attractors (`lcpstep.analysis.attractors.Attractor`): impact map and stroboscopic map."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(12, 5), layout="constrained")
    figure.suptitle(title)
    left, right = figure.subplots(1, 2)
    for a in found:
        mark = "o" if a.periods else ","
        left.plot(a.impact_phase, a.impact_after, mark, ms=4, label=a.name)
        right.plot(
            a.points[:, 0], a.points[:, a.points.shape[1] // 2], mark, ms=4, label=f"{a.name}: {a.share:.0%}"
        )
    left.set(title="impacts", xlabel="phase [periods]", ylabel="gap velocity after [m/s]")
    right.set(title="once per period", xlabel="position [m]", ylabel="velocity [m/s]")
    right.legend()
    return figure


def branch(data: Any, title: str = "") -> Any:
    """Figure of a branch of periodic orbits: states on the section, stable ones solid, and the multipliers."""
    from matplotlib.figure import Figure

    parameter = str(data.attrs["parameter"])
    p, stable = data[parameter].values, data["stable"].values.astype(bool)
    figure = Figure(figsize=(10, 8), layout="constrained")
    figure.suptitle(title)
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(p, data["x"].values[:, -1], "k:", lw=1)
    above.plot(np.where(stable, p, np.nan), data["x"].values[:, -1], "k-", lw=1.5, label="stable")
    for kind in dict.fromkeys(data["special_kind"].values):
        which = data["special_kind"].values == kind
        above.plot(data["special_p"].values[which], data["special_x"].values[which, -1], "o", label=str(kind))
    above.set(ylabel="velocity on the section [m/s]")
    above.legend()
    below.plot(p, data["multiplier_modulus"].values, ".", ms=3)
    below.axhline(1.0, color="0.5")
    below.set(ylabel="modulus of the multipliers", xlabel=parameter)
    return figure
