"""A periodic orbit, proved
========================

That a computer finds an orbit does not prove that there is one. Here it is proved: in ball arithmetic, where
every number carries its error, a theorem of Krawczyk shows that O(1, 1) of the cam-follower at 700 rpm exists,
alone near the computed one, and is stable. Its impact time is then known to thirty digits.

Source: R. Krawczyk (1969); F. Johansson, Arb (2017). Needs python-flint: `pip install "lcpstep[proofs]"`.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep.analysis.orbits import PeriodicOrbit, periodic_orbit
from lcpstep.analysis.proofs import Proof, prove


def orbit() -> PeriodicOrbit:
    """One impact in each turn."""
    return periodic_orbit(scenes.cam_follower(rpm=700.0), [1.33, -66.2])


def proof() -> Proof:
    """What is proved of it."""
    return prove(orbit())


def picture() -> Figure:
    """Follower and cam over one turn."""
    found = orbit()
    scene, run = found.scene, found.run()
    t = np.unique(np.concatenate([np.linspace(run.t[0], run.t[-1], 2001), found.time]))
    gap = run.at(t)[0][:, 0]
    lift = scenes.cam_follower(rpm=700.0, coordinates="absolute")
    cam = np.array([-lift.gap(x, [0.0], [0.0])[0][0] for x in t])
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    ax = figure.subplots()
    ax.fill_between(t / scene.period, cam, 0.0, color="0.8", label="cam")
    ax.plot(t / scene.period, cam + gap, "C0-", lw=1.6, label="follower")
    ax.plot(
        found.time / scene.period, cam[np.searchsorted(t, found.time)], "C3o", ms=8, label="impact, proved"
    )
    ax.set(
        xlabel="time [turns of the cam]",
        ylabel="positions of cam and follower [m]",
        xlim=(0.0, 1.0),
        ylim=(0.0, None),
    )
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(proof())
    picture().savefig("proof.png")
