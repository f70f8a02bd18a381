"""Pictures of studies: basins, attractors, branches of periodic orbits."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

COLOURS = "tab20"


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
