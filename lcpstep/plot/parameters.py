"""Measures of a parameter study over the first parameter that varies, a line for each value of the others."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np

from lcpstep.plot import looks

MOST = 10  # lines with a name of their own


def measures(data: Any, sweep: Sequence[str], names: Sequence[str]) -> Any:
    """One panel for each measure; legends beside them."""
    from lcpstep.plot.figures import Figure

    if not sweep:
        raise ValueError("picture: expected a parameter in [sweep] to draw over")
    figure = Figure(figsize=(9.0, 0.6 + 2.2 * len(names)), layout="constrained")
    axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
    across, others = sweep[0], list(sweep[1:])
    combined = list(itertools.product(*(range(data.sizes[name]) for name in others)))
    for ax, name in zip(axes, names, strict=True):
        for k, at in enumerate(combined):
            picked = data[name].isel(dict(zip(others, at, strict=True)))
            values = picked.transpose(across, ...).values.reshape(data.sizes[across], -1)
            words = ", ".join(f"{o} = {_shown(data[o].values[i])}" for o, i in zip(others, at, strict=True))
            for j in range(values.shape[1]):
                label = words if j == 0 and k < MOST else None
                ax.plot(
                    data[across].values,
                    values[:, j],
                    looks.mark(k) + looks.STYLES[j % 4],
                    color=f"C{k % 10}",
                    ms=3,
                    lw=1,
                    label=label,
                )
        unit = data[name].attrs.get("units", "1")
        ax.set_ylabel(name.replace("_", " ") + (f" [{unit}]" if unit != "1" else ""))
        ax.grid(alpha=0.3)
    axes[-1].set_xlabel(across)
    figure.suptitle(str(data.attrs["scene"]))
    handles, labels = axes[0].get_legend_handles_labels()
    if others and handles:
        figure.legend(handles, labels, loc="outside right upper", frameon=False, fontsize=8)
    return figure


def _shown(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, (float, np.floating)) else str(value)
