"""Chapter 2: a cascade of flips
=============================

The logistic map x -> r x (1 - x) doubles its period at r = 3, at 1 + sqrt(6), and again ever faster, until it
is chaotic; at 1 + sqrt(8) a window of period three opens. Above its orbits over r, below the largest Lyapunov
exponent, which is positive in chaos and touches zero at every flip.

Source: R. M. May (1976); G. Osorio, Complex Behavior in Impacting Systems, chapter 2, on smooth bifurcations of
maps.
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lcpstep.analysis.fixed_points import periodic_point
from lcpstep.analysis.map_diagram import map_diagram
from lcpstep.maps.formulas import named

FLIPS = {"flip": 3.0, "second flip": 1.0 + math.sqrt(6.0), "period three": 1.0 + math.sqrt(8.0)}


def multiplier_at_the_flip() -> float:
    """Of the period two at r = 1 + sqrt(6): -1."""
    point = periodic_point(named("logistic").at(r=1.0 + math.sqrt(6.0)), [0.44], 2)
    return float(point.multipliers[0].real)


def picture() -> Figure:
    """Orbits and exponents over r."""
    data = map_diagram(named("logistic"), "r", np.linspace(2.8, 4.0, 301), drop=300, keep=150, jobs=1)
    r, x = data["r"].values, data["x"].values[..., 0]
    figure = Figure(figsize=(8.0, 5.4), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1.0])
    above.plot(np.repeat(r, x.shape[1]), x.ravel(), "k.", ms=1.0, mew=0.0, rasterized=True)
    below.plot(r, data["lyapunov"].values, "C0-", lw=0.9)
    below.axhline(0.0, color="0.4", lw=0.8)
    for (name, at), line in zip(FLIPS.items(), ("--", "-.", ":"), strict=True):
        for ax in (above, below):
            ax.axvline(at, color="C3", ls=line, lw=1.0, label=f"{name}: {at:.5f}")
    above.set(ylabel="x", ylim=(0.0, 1.0))
    below.set(xlabel="r", ylabel="exponent", xlim=(2.8, 4.0), ylim=(-1.5, 0.8))
    above.legend(loc="lower left")
    return figure


if __name__ == "__main__":
    print("multiplier at 1 + sqrt(6):", multiplier_at_the_flip())
    picture().savefig("chapter-2-flips.png", dpi=110)
