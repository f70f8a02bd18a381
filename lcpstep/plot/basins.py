"""Pictures of basins of attraction."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import checks
from lcpstep.plot import looks

OBSTACLE, NONE = (0.6, 0.6, 0.6), (1.0, 1.0, 1.0)


def basins(data: Any, title: str = "") -> Any:
    """Figure of a basin dataset: one shade an attractor, white for none, grey for the obstacle."""
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.basins")
    from lcpstep.plot.figures import Figure

    label = data["label"].values
    shades = np.array([OBSTACLE, NONE, *looks.shades(len(data["name"]))])
    figure = Figure(figsize=(9, 7), layout="constrained")
    ax = figure.subplots()
    extent = (*edges(data["q"].values), *edges(data["v"].values))
    pixels = np.round(255.0 * shades).astype(np.uint8)[label + 2]
    ax.imshow(pixels, origin="lower", aspect="auto", extent=extent)
    shares = zip(data["name"].values, data["share"].values, data["share_error"].values, strict=True)
    for k, (name, share, error) in enumerate(shares):
        ax.plot([], [], "s", color=shades[k + 2], label=f"{name}: {share:.4f} ± {error:.4f}")
    for number, shade, name in ((-1, NONE, "none"), (-2, OBSTACLE, "obstacle")):
        if np.any(label == number):
            ax.plot([], [], "s", mfc=shade, mec="0.4", label=name)
    figure.legend(loc="outside lower center", ncols=3)
    labels = data.attrs.get("labels", ("position [m]", "velocity [m/s]"))
    ax.set(title=title, xlabel=labels[0], ylabel=labels[1])
    return figure


def edges(centres: Any) -> tuple[float, float]:
    """Where the first of these cells begins and the last ends."""
    half = 0.5 * (centres[-1] - centres[0]) / max(len(centres) - 1, 1)
    return centres[0] - half, centres[-1] + half
