"""A pile at rest and the forces in it
===================================

Twenty beads fall on a floor and come to rest on each other. Each contact then carries the weight above it: the
lowest all twenty, the highest one. Nothing sinks and nothing trembles, although the run has no penalty springs
to tune.

Source: statics; the scene is `lagrangian.scenes.column`.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import Moreau, Trajectory, simulate

GRAVITY = 9.81


def pile(n: int = 20) -> Trajectory:
    """The column falling and at rest."""
    return simulate(scenes.column(n=n), Moreau(h=1e-3))


def forces(run: Trajectory) -> np.ndarray:
    """Contact forces during the last tenth of a second, from the floor upwards [N]."""
    last = run.t > run.t[-1] - 0.1
    return run.impulse[last].sum(axis=0) / np.ptp(np.append(run.t[~last][-1], run.t[last]))


def picture() -> Figure:
    """How the beads fall, and what the contacts carry in the end."""
    run = pile()
    n = run.scene.n_q
    figure = Figure(figsize=(8.5, 4.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1.5, 1.0])
    left.plot(run.t, run.q, "k-", lw=0.7)
    left.set(
        xlabel="time t [s]", ylabel="height of each bead, less its place in the pile [m]", xlim=(0.0, 1.0)
    )
    right.barh(np.arange(n), forces(run), color="C0", label="simulated")
    right.plot(GRAVITY * (n - np.arange(n)), np.arange(n), "k|", ms=11, mew=1.6, label="weight above")
    right.set(xlabel="contact force [N]", ylabel="contact, from the floor up", yticks=range(0, n, 4))
    right.legend(loc="upper right")
    for ax in (left, right):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("from the floor up:", forces(pile()).round(9), "N")
    picture().savefig("pile-at-rest.png")
