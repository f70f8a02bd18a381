"""Two motions of one driven oscillator
====================================

A mass between two springs, the right one sixteen times as stiff, driven at one and the same frequency. It has
two stable motions: one repeats with the drive, O(1, 2), the other with every third period, O(3, 6). Which comes
about is a matter of the start. O(n, m) repeats after n periods with m changes of the spring.

Source: S. W. Shaw, P. J. Holmes, A periodically forced piecewise linear oscillator (1983).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven
from lcpstep.analysis.attractors import attractors, random_starts
from lcpstep.analysis.orbits import PeriodicOrbit, periodic_orbit


def orbits() -> list[PeriodicOrbit]:
    """What ten random starts settle to, as periodic orbits."""
    scene = scenes.driven_bilinear_oscillator()
    starts = random_starts([[-2, -4], [2, 4]], 10, seed=0)
    found = attractors(scene, EventDriven(), starts, transient=200, window=24, longest=6).found
    return [periodic_orbit(scene, a.points[0], a.periods) for a in found]


def picture(found: list[PeriodicOrbit]) -> Figure:
    """Both orbits in the plane of place and velocity, and over time."""
    figure = Figure(figsize=(9.0, 4.2), layout="constrained")
    plane, series = figure.subplots(1, 2, width_ratios=[1.0, 1.4])
    for orbit, style in zip(found, ("C0-", "C1--"), strict=False):
        run = orbit.run()
        t = np.linspace(run.t[0], run.t[-1], 3001)
        x = run.at(t)
        plane.plot(x[:, 0], x[:, 1], style, lw=1.4)
        turns = 3 // orbit.periods
        shown = np.linspace(0.0, 3.0, turns * len(t))
        series.plot(shown, np.tile(x[:, 0], turns), style, lw=1.4, label=orbit.name)
    plane.set(xlabel="place x [m]", ylabel="velocity [m/s]")
    series.set(xlabel="time [periods of the drive]", ylabel="place x [m]", xlim=(0.0, 3.0))
    series.axhline(0.0, color="0.5", lw=0.8)
    series.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2, frameon=False)
    for ax in (plane, series):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    found = orbits()
    print([(orbit.name, np.abs(orbit.multipliers).round(4)) for orbit in found])
    picture(found).savefig("two-stiffnesses.png")
