"""Chapter 3: chaos on two sections
================================

The cam-follower at 660 rpm never repeats itself, but what it does has a shape. Left, every impact: when in the
turn, and how fast the follower leaves. Right, its state once a turn. By the event-driven method and by
time-stepping with h = 1e-4 s: single motions differ after some turns, the shape does not.

Source: G. Osorio, Complex Behavior in Impacting Systems, Fig 3.6.
"""

from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Moreau
from lcpstep.analysis.lyapunov import Lyapunov, lyapunov
from lcpstep.analysis.variation import PeriodMap
from lcpstep.maps import Sections, sections


def both(periods: int = 3000) -> dict[str, Sections]:
    """Sections of so many turns, the first 300 left out."""
    scene = scenes.cam_follower(rpm=660.0)
    methods = {"event-driven": EventDriven(), "Moreau, h = 1e-4 s": Moreau(h=1e-4)}
    return {name: sections(scene, method, periods, 300) for name, method in methods.items()}


def exponent() -> Lyapunov:
    """Largest Lyapunov exponent per turn: positive in chaos."""
    return lyapunov(PeriodMap(scenes.cam_follower(rpm=660.0), EventDriven(), 0.0), [0.4, 0.4], 2000, 200)


def picture() -> Figure:
    """The impact map and the stroboscopic map, by both methods."""
    figure = Figure(figsize=(9.0, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    for (name, found), (colour, size) in zip(both().items(), (("0.65", 4.0), ("C0", 1.6)), strict=True):
        left.plot(found.phase, found.after, ".", color=colour, ms=size, mew=0.0, rasterized=True)
        right.plot(
            found.q[:, 0], found.v[:, 0], ".", color=colour, ms=size, mew=0.0, label=name, rasterized=True
        )
    left.set(
        xlabel="phase of the impact [turns]", ylabel="velocity after it, off the cam [m/s]", xlim=(0.0, 1.0)
    )
    right.set(xlabel="position over the cam [m]", ylabel="velocity [m/s]")
    figure.legend(loc="outside upper right", ncols=2, markerscale=6.0, frameon=False)
    for ax in (left, right):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("largest Lyapunov exponent per turn:", exponent().largest)
    picture().savefig("chapter-3-chaotic-cam.png", dpi=110)
