"""Figs 3.2 and 3.3: the cam with lift, velocity and acceleration, and profiles of other smoothness."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.scenes.cam_follower import PROFILE

Array = NDArray[np.float64]
ROWS = ("lift [m]", "dc/dβ [m]", "d²c/dβ² [m]")


def profile() -> tuple[Any, dict[str, Any]]:
    """Fig 3.2."""
    from matplotlib.figure import Figure

    beta = np.linspace(0.0, 2.0 * math.pi, 4001)
    corners = np.sort(PROFILE.corners())
    beta = beta[np.min(np.abs(beta[:, None] - corners), axis=1) > 1e-9]  # on a corner there are two values
    lift = np.array([PROFILE.lift(float(b)) for b in beta])
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    figure.suptitle("the cam of circular arcs: outline and lift over its angle, corners dotted")
    grid = figure.add_gridspec(3, 2, width_ratios=[1.0, 1.6])
    outline = figure.add_subplot(grid[:, 0])
    radius = lift[:, 0] + PROFILE.offset
    outline.plot(radius * np.cos(beta), radius * np.sin(beta), "k-", lw=1.5)
    outline.plot(0.0, 0.0, "k+")
    at = np.array([PROFILE.lift(float(b))[0] + PROFILE.offset for b in corners])
    outline.plot(at * np.cos(corners), at * np.sin(corners), "C0.", ms=8)
    outline.set_aspect("equal")
    outline.set(xlabel="x [m]", ylabel="y [m]")
    for k, label in enumerate(ROWS):
        ax = figure.add_subplot(grid[k, 1])
        curve(ax, beta, lift[:, k], corners)
        ax.set(ylabel=label, xlim=(0.0, 2.0 * math.pi))
        if k < 2:
            ax.tick_params(labelbottom=False)
    ax.set_xlabel("cam angle β [rad]")
    return figure, {"beta": beta, "lift": lift, "corners": corners}


def curve(ax: Any, x: Array, y: Array, corners: Array) -> None:
    """A curve that is broken at the corners, where it may jump."""
    cuts = np.searchsorted(x, corners)
    ax.plot(np.insert(x, cuts, np.nan), np.insert(y, cuts, np.nan), "k-", lw=1.2)
    for corner in corners:
        ax.axvline(corner, color="C0", ls=":", lw=0.8)
    ax.grid(alpha=0.3)


def smoothness() -> tuple[Any, dict[str, Any]]:
    """Fig 3.3: a rise of 0.15 m over half a radian by ramps, by parabolas, and by a cycloid."""
    from matplotlib.figure import Figure

    length, height, n = 1.0, 0.15, 1501
    x = np.linspace(-0.25, 1.25, n)
    inside = (x >= 0.0) & (x < length)
    s = np.clip(x / length, 0.0, 1.0)
    early = s < 0.5
    ramp = np.array([s, np.where(inside, 1.0, 0.0), np.zeros(n)])
    parabolas = np.array([
        np.where(early, 2.0 * s**2, 1.0 - 2.0 * (1.0 - s) ** 2), np.where(early, 4.0 * s, 4.0 * (1.0 - s)),
        np.where(inside, np.where(early, 4.0, -4.0), 0.0),
    ])  # fmt: skip
    turn = 2.0 * math.pi
    cycloid = np.array([
        s - np.sin(turn * s) / turn, np.where(inside, 1.0 - np.cos(turn * s), 0.0),
        np.where(inside, turn * np.sin(turn * s), 0.0),
    ])  # fmt: skip
    kinds = {
        "degree one: velocity jumps": (ramp, (0.0, 1.0)),
        "degree two: acceleration jumps": (parabolas, (0.0, 0.5, 1.0)),
        "degree three: jerk jumps": (cycloid, (0.0, 1.0)),
    }
    figure = Figure(figsize=(11, 6.5), layout="constrained")
    figure.suptitle("rises of other smoothness, 0.15 m over 1 rad; corners dotted")
    axes = figure.subplots(3, 3, sharex=True)
    for column, (name, (c, corners)) in zip(axes.T, kinds.items(), strict=True):
        for k, ax in enumerate(column):
            curve(ax, x, height * c[k], np.array(corners))
            if column is axes.T[0] or name.startswith("degree one"):
                ax.set_ylabel(ROWS[k])
        column[0].set_title(name, fontsize=10)
        column[-1].set_xlabel("cam angle [rad]")
    return figure, {"angle": x} | {name: height * c for name, (c, _) in kinds.items()}
