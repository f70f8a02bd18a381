"""A slider-crank with play
========================

The slider of a crank mechanism has one millimetre of play in its guide. Its four corners strike the guide again
and again, two of them nearly at once; with a little dry friction each of them slides and sticks besides.

Source: P. Flores, J. Ambrosio, Revolute joints with clearance in multibody systems (2004); C. Studer (2009).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate


def short_run(mu: float = 0.01) -> Trajectory:
    """The mechanism for a twentieth of a second."""
    return simulate(scenes.slider_crank(mu=mu, t_end=0.05), EventDriven(rtol=1e-9, atol=1e-9))


def gaps(run: Trajectory, t: np.ndarray) -> np.ndarray:
    """Distances of the four corners from the guide, (n, 4) [m]."""
    q, v = run.at(t)
    return np.array([run.scene.gap(*state)[0] for state in zip(t, q, v, strict=True)])


def picture() -> Figure:
    """The distances of the corners from the guide, and the impulses of their impacts."""
    run = short_run()
    log = run.impacts[run.impacts.kind == Kind.IMPACT]
    t = np.unique(np.concatenate([np.linspace(0.0, 0.05, 1500), log.time]))
    figure = Figure(figsize=(8.5, 5.6), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    distances = 1e3 * gaps(run, t)
    for first, line in ((0, "-"), (2, "--")):  # two corners of one side are less than a micrometre apart
        nearer = distances[:, first : first + 2].min(axis=1)
        above.plot(1e3 * t, nearer, line, lw=1.3, label=f"corners {first + 1}, {first + 2}")
    for corner, (marker, size) in enumerate((("o", 9), (".", 5), ("s", 9), ("x", 5))):
        own = log[log.contact == corner]
        below.semilogy(
            1e3 * own.time,
            own.impulse,
            marker,
            mfc="none",
            ms=size,
            color=f"C{corner}",
            label=f"corner {corner + 1}",
        )
    above.set(ylabel="distance from the guide [mm]", ylim=(0.0, None))
    below.set(xlabel="time t [ms]", ylabel="impulse [N s]", xlim=(0.0, 50.0), ylim=(1e-7, None))
    for ax in (above, below):
        ax.grid(alpha=0.3)
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    return figure


if __name__ == "__main__":
    print(len(short_run().impacts), "events of four corners in a twentieth of a second")
    picture().savefig("slider-crank.png")
