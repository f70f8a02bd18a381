"""Chapter 5: an impact on a corner of the cam
===========================================

The flanks of the cam are circles that meet in corners, where its acceleration jumps. At 673.234 rpm the impact
of O(1, 1) falls right on one: below, the orbit does not exist; above, a stable and an unstable one. A
piecewise-linear map, derived from the motion to both sides of the corner, says what happens, and the full
system does it.

Source: G. Osorio, Complex Behavior in Impacting Systems, Fig 5.4.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven
from lcpstep.analysis.border_collision import classify, diagram
from lcpstep.analysis.corners import CornerImpact, corner_impact, local_map
from lcpstep.maps import periods


def make(rpm: float):
    return scenes.cam_follower(rpm=rpm)


def orbit() -> CornerImpact:
    """O(1, 1) where its impact lies on the corner."""
    return corner_impact(make, 673.0, periods(make(700.0), EventDriven(), [0.4, 0.4], 400).final[0])


def picture(at: CornerImpact) -> Figure:
    """Where the local map and the full system settle, beside the corner impact."""
    chain = local_map(at)
    speeds = at.p + np.linspace(-0.7, 0.7, 81)
    local = [at.x[0] + y[:, 0] for y in diagram(chain, speeds - at.p, drop=2000, keep=40)]
    full = [
        periods(make(float(p)), EventDriven(), at.x, 2040, drop=2000, most=0, strict=False).states[0][:, 0]
        for p in speeds
    ]
    figure = Figure(figsize=(8.5, 4.2), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    for ax, points, title in zip(axes, (local, full), ("piecewise-linear map", "cam-follower"), strict=True):
        x = np.concatenate([np.full(len(y), p) for p, y in zip(speeds, points, strict=True)])
        ax.plot(x - at.p, np.concatenate(points), "k.", ms=2.5, mew=0.0, rasterized=True)
        ax.axvline(0.0, color="C3", lw=1.0, ls="--")
        ax.set(title=title, xlabel=f"cam speed - {at.p:.6f} [rpm]", xlim=(-0.7, 0.7))
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("position once a turn [m]")
    figure.suptitle(classify(chain).words, fontsize=10)
    return figure


if __name__ == "__main__":
    at = orbit()
    print(f"the impact lies on the corner at {at.p:.9f} rpm")
    picture(at).savefig("chapter-5-corner-impact.png", dpi=110)
