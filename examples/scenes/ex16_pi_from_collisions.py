"""Pi from collisions
==================

A block of mass 100^k slides towards one of mass 1 in front of a wall; nothing is lost. They collide, with each
other and with the wall, as many times as the first k + 1 digits of pi say: 3, 31, 314, 3141. In the coordinates
sqrt(m) q the pair is a ray of light between two mirrors.

Source: G. Galperin, Playing pool with pi, Regular and Chaotic Dynamics 8 (2003).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate


def run_of_blocks(k: int) -> Trajectory:
    """The blocks with masses 1 and 100^k."""
    return simulate(scenes.galperin(k=k), EventDriven())


def collisions(k: int) -> int:
    """How many there are."""
    return int(np.sum(run_of_blocks(k).impacts.kind == Kind.IMPACT))


def picture() -> Figure:
    """The ray between its mirrors for k = 1: every corner is a collision."""
    run = run_of_blocks(1)
    hits = run.impacts.time[run.impacts.kind == Kind.IMPACT]
    t = np.concatenate([[hits[0] - 0.6], hits, [hits[-1] + 0.6]])
    small, large = run.at(t)[0].T
    figure = Figure(figsize=(8.0, 4.2), layout="constrained")
    ax = figure.subplots()
    x, y = 10.0 * large, small
    ax.plot(x, y, "C0-", lw=1.1, label="the two blocks")
    ax.plot(x[1:-1], y[1:-1], "k.", ms=5, label=f"{len(hits)} collisions")
    ends = np.array([0.0, x.max()])
    ax.plot(ends, 0.0 * ends, color="0.4", lw=2.5, label="mirror: the wall")
    ax.plot(ends, ends / 10.0, color="0.4", lw=2.5, ls="--", label="mirror: the blocks touch")
    ax.set(xlabel="sqrt(mass) times place of the heavy block", ylabel="place of the light block")
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("collisions for k = 0, 1, 2, 3:", [collisions(k) for k in range(4)])
    picture().savefig("pi-from-collisions.png")
