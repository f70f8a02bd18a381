"""Chapter 7: an anti-lock brake with a hybrid controller
======================================================

Four states raise, hold, lower and hold the torque of a brake; each is left where slip or torque passes a
threshold. The wheel settles to a cycle at once, for its map has the multiplier zero. From too much slip and
torque it locks: slip one.

Source: G. Osorio, Complex Behavior in Impacting Systems, chapter 7.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate
from lcpstep.analysis.abs_cycle import Cycle, limit_cycle


def cycle() -> Cycle:
    """The limit cycle on a dry road."""
    return limit_cycle(scenes.hybrid_abs("dry"))


def picture() -> Figure:
    """Slip and torque from three starts: over time, and in their plane."""
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    grid = figure.add_gridspec(2, 2, width_ratios=[1.2, 1.0])
    slip, torque = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    plane = figure.add_subplot(grid[:, 1])
    for start, line in (((0.08, 1000.0), "C0-"), ((0.3, 1300.0), "C1--"), ((0.02, 400.0), "C2:")):
        run = simulate(scenes.hybrid_abs("dry", slip=start[0], torque=start[1], t_end=2.0), EventDriven())
        t = np.unique(np.concatenate([np.linspace(0.0, run.t[-1], 3001), run.switches.time]))
        x = run.at(t)
        slip.plot(t, x[:, 0], line, lw=1.2)
        torque.plot(t, x[:, 1], line, lw=1.2)
        plane.plot(x[:, 0], x[:, 1], line, lw=1.4, label=f"from {start[0]:g}, {start[1]:g} N m")
    slip.set(ylabel="slip [-]", xlim=(0.0, 2.0))
    torque.set(xlabel="time t [s]", ylabel="brake torque [N m]", xlim=(0.0, 2.0))
    plane.set(xlabel="slip [-]", ylabel="brake torque [N m]")
    figure.legend(loc="outside upper right", ncols=3, frameon=False)
    for ax in (slip, torque, plane):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"the cycle takes {cycle().period:.12f} s")
    picture().savefig("chapter-7-anti-lock-brake.png")
