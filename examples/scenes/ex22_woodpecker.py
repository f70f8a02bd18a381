"""The woodpecker toy
==================

A sleeve with play slides down a pole, a bird on a spring beside it. It jams, the bird swings back and frees it,
it slips, jams again: pecking, again and again, 0.146 s each time. Impacts, sticking and sliding friction all
play their part.

Source: R. I. Leine, C. Glocker, D. H. van Campen, Nonlinear dynamics and modeling of various wooden toys with
impact and friction (2003).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate


def pecking(t_end: float = 1.5) -> Trajectory:
    """The toy from near its periodic motion."""
    return simulate(scenes.woodpecker(t_end=t_end), EventDriven(rtol=1e-9, atol=1e-9))


def period() -> float:
    """Time between the last two blows of the beak [s]."""
    log = pecking().impacts
    blows = log.time[(log.contact == 0) & (log.kind == Kind.IMPACT) & (log.before < -0.1)]
    return float(np.diff(blows)[-1])


def picture() -> Figure:
    """Angle of the bird, height of the sleeve, and what strikes the pole."""
    run = pecking(0.6)
    t = np.linspace(0.0, 0.6, 2001)
    q, v = run.at(t)
    figure = Figure(figsize=(9.0, 4.8), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=[1.5, 1.0])
    angle, height = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    plane = figure.add_subplot(grid[:, 1])
    angle.plot(t, q[:, 2], lw=1.3)
    angle.set(ylabel="angle of the bird [rad]", xlim=(0.0, 0.6))
    height.plot(t, 1e3 * (q[:, 0] - q[0, 0]), lw=1.3)
    height.set(xlabel="time t [s]", ylabel="sleeve, from its start [mm]", xlim=(0.0, 0.6))
    late = t > 0.3
    plane.plot(q[late, 2], v[late, 2], "k-", lw=0.9)
    plane.set(xlabel="angle of the bird [rad]", ylabel="its rate [rad/s]", title="the cycle")
    for ax in (angle, height, plane):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"it pecks every {period():.5f} s")
    picture().savefig("woodpecker.png")
