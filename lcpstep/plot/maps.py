"""Pictures of maps given by formulas: the bifurcation diagram, and below it the largest exponent."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import checks
from lcpstep.plot.bifurcation import thinned


def map_diagram(data: Any, title: str = "", coordinate: int = 0) -> Any:
    """Figure of a dataset of `lcpstep.analysis.map_diagram`; coordinate: which one is drawn."""
    checks.has("data", data, "attrs", "a dataset of lcpstep.analysis.map_diagram")
    from lcpstep.plot.figures import Figure

    parameter = str(data.attrs["parameter"])
    values = data[parameter].values
    figure = Figure(figsize=(11, 7.5), layout="constrained")
    figure.suptitle(title)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1.0])
    y = data["x"].values[..., coordinate]
    x, y = thinned(np.broadcast_to(values[:, None], y.shape).ravel(), y.ravel())
    size = float(np.clip(1000.0 / len(values), 0.9, 4.0))
    above.plot(x, y, "k.", ms=size, mew=0.0, rasterized=True)
    above.set_ylabel("x" if data.sizes["state"] == 1 else f"x{coordinate + 1}")
    exponent = data["lyapunov"].values
    below.axhline(0.0, color="0.5", lw=0.8)
    below.plot(values, np.where(np.isfinite(exponent), exponent, np.nan), "C0-", lw=0.9)
    below.set(xlabel=parameter, ylabel="largest Lyapunov exponent\nper iteration")
    if len(values) > 1:
        below.set_xlim(values[0], values[-1])
    lost = ~np.isfinite(data["x"].values[:, 0, 0])
    if np.any(lost):
        above.plot(
            values[lost], np.full(np.sum(lost), 1.0), "x", color="C3", ms=4, clip_on=False,
            transform=above.get_xaxis_transform(), label="the orbit leaves all bounds",
        )  # fmt: skip
        above.legend(loc="lower right", bbox_to_anchor=(1.0, 1.02), fontsize=8, frameon=False)
    for ax in (above, below):
        ax.grid(alpha=0.3)
    return figure
