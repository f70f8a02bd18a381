"""A block that rocks
==================

A tall block let go on one edge falls back, strikes the floor with the other edge and rises again, a little less
each time: an impact leaves 1 - 3/2 sin^2(alpha) of the rate. Bounces grow ever shorter and end, like those of a
ball, in finite time.

Source: G. W. Housner, The behavior of inverted pendulum structures during earthquakes (1963).
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate

B, H = 0.1, 0.4  # half width and half height [m]


def run_of_block():
    """Six seconds; the coordinate is the size of the angle."""
    return simulate(scenes.rocking_block(b=B, h=H), EventDriven(rtol=1e-11, atol=1e-11))


def loss_error() -> float:
    """How far the ratio of rates after and before the impacts is from Housner's, at worst."""
    log = run_of_block().impacts
    log = log[(log.kind == Kind.IMPACT) & (log.before < -1e-3)]
    return float(abs(log.after / -log.before - housner()).max())


def housner() -> float:
    """What an impact leaves of the rate."""
    return 1.0 - 1.5 * math.sin(math.atan(B / H)) ** 2


def picture() -> Figure:
    """The angle to either side, and the rate before each impact beside Housner's geometric sequence."""
    run = run_of_block()
    log = run.impacts[run.impacts.kind == Kind.IMPACT]
    t = np.unique(np.concatenate([np.linspace(*run.t[[0, -1]], 6000), log.time]))
    side = np.where(np.searchsorted(log.time, t, side="right") % 2, -1.0, 1.0)
    figure = Figure(figsize=(8.0, 5.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(t, side * run.at(t)[0][:, 0], lw=1.1)
    above.set(ylabel="angle [rad]")
    below.semilogy(log.time, -log.before, "o", ms=4, label="simulated")
    below.semilogy(log.time, -log.before[0] * housner() ** np.arange(len(log)), "k-", lw=0.8, label="Housner")
    below.set(xlabel="time t [s]", ylabel="rate before impact [rad/s]", ylim=(1e-4, 2.0))
    below.legend(loc="upper right")
    for ax in (above, below):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"an impact leaves {housner():.6f} of the rate; largest deviation {loss_error():.1e}")
    picture().savefig("rocking-block.png")
