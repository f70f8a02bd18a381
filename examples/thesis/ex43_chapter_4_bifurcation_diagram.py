"""Chapter 4: a bifurcation diagram of the cam-follower
====================================================

What the follower settles to, over the speed of the cam from 660 to 760 rpm: chaos, a sudden end of it, one
impact a turn, and at 739.32 rpm the flip to two. Phases of impacts above, where blue lines are the corners of
the cam; the place once a turn below.

Source: G. Osorio, Complex Behavior in Impacting Systems, Fig 4.12.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep.analysis.bifurcation import bifurcation
from lcpstep.analysis.orbits import continue_orbit, periodic_orbit
from lcpstep.plot.bifurcation import panel


def flip() -> float:
    """Speed of the flip of O(1, 1) [rpm], by following the orbit."""
    orbit = periodic_orbit(scenes.cam_follower(rpm=730.0), [1.33, -66.2])
    branch = continue_orbit(lambda rpm: scenes.cam_follower(rpm=rpm), orbit, 730.0, (725.0, 745.0))
    return next(special.p for special in branch.special if special.kind == "flip")


def picture() -> Figure:
    """The diagram of 300 speeds."""
    data = bifurcation(scenes.cam_follower, "rpm", np.linspace(660.0, 760.0, 300), drop=400, keep=60, jobs=1)
    figure = Figure(figsize=(8.5, 6.0), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    for ax, name in zip(axes, ("phase", "position"), strict=True):
        panel(ax, data, name)
        ax.grid(alpha=0.3)
    axes[-1].set(xlabel="cam speed [rpm]", xlim=(660.0, 760.0))
    return figure


if __name__ == "__main__":
    print(f"flip at {flip():.7f} rpm")
    picture().savefig("chapter-4-bifurcation-diagram.png", dpi=110)
