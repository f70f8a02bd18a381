"""Grazing: where impacts are born
===============================

A particle is pushed off a surface just before it would touch. Where it would dip below by d, it strikes with
the speed sqrt(2 a d): a square root, whose slope is infinite at d = 0. That is why grazing destroys half of the
digits, and why a step that looks at gaps only at its ends misses such an impact altogether.

Source: A. B. Nordmark, Non-periodic motion caused by grazing incidence in an impact oscillator (1991).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Moreau, simulate

DEPTHS = np.logspace(-12.0, -1.0, 23)  # [m]


def speed(d: float, method=None) -> float:
    """Speed of the first impact [m/s]; 0 where there is none."""
    log = simulate(scenes.grazing(d=d), method or EventDriven()).impacts
    return -float(log.before[0]) if len(log) else 0.0


def largest_error() -> float:
    """Relative error of the speeds, over all depths."""
    return max(abs(speed(d) / np.sqrt(2.0 * d) - 1.0) for d in DEPTHS)


def picture() -> Figure:
    """Speed of the impact over the depth."""
    figure = Figure(figsize=(7.0, 4.4), layout="constrained")
    ax = figure.subplots()
    ax.loglog(DEPTHS, np.sqrt(2.0 * DEPTHS), "k-", lw=0.8, label="sqrt(2 a d)")
    ax.loglog(DEPTHS, [speed(d) for d in DEPTHS], "o", ms=7, mfc="none", label="EventDriven")
    stepped = np.array([speed(d, Moreau(h=1e-2)) for d in DEPTHS])
    seen = stepped > 0.0
    ax.loglog(DEPTHS[seen], stepped[seen], "s", ms=4, color="C1", label="Moreau, h = 0.01 s")
    ax.axvspan(DEPTHS[0], DEPTHS[~seen].max(), color="C1", alpha=0.12, label="Moreau misses the impact")
    ax.set(xlabel="depth d that would be reached [m]", ylabel="speed of the impact [m/s]")
    ax.legend(loc="upper left")
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"speeds are sqrt(2 a d) to {largest_error():.1e}")
    picture().savefig("grazing.png")
