"""Landing on a slope: does it stick?
==================================

A block falls on a slope and does not rebound. Friction acts in the impact too: it sticks on the spot if its
speed along the slope is at most mu times the speed with which it lands, and loses mu times that speed
otherwise. A method that forgets the impulse of friction has it slide on.

Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (1988).
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate

SLOPE, HEIGHT, GRAVITY = 0.3, 0.2, 9.81
LANDING = math.sqrt(2.0 * GRAVITY * math.cos(SLOPE) * HEIGHT)  # speed on the slope's normal [m/s]
FALL = LANDING / (GRAVITY * math.cos(SLOPE))  # [s]


def after(mu: float, v0: float) -> float:
    """Speed along the slope right after the landing [m/s]."""
    scene = scenes.slope_landing(slope=SLOPE, height=HEIGHT, v0=v0, mu=mu, t_end=FALL + 1e-3)
    return float(simulate(scene, EventDriven()).at(FALL + 1e-9)[1][0])


def expected(mu: float, v0: float) -> float:
    """The same by Coulomb's law for impulses."""
    arriving = v0 + GRAVITY * math.sin(SLOPE) * FALL
    return max(0.0, arriving - mu * LANDING)


def picture() -> Figure:
    """Speeds after the landing over the coefficient of friction."""
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    ax = figure.subplots()
    mu = np.linspace(0.35, 2.0, 34)
    for v0, marker in ((0.5, "o"), (1.5, "s"), (3.0, "^")):
        ax.plot(mu, [expected(m, v0) for m in mu], "k-", lw=0.8)
        ax.plot(mu, [after(m, v0) for m in mu], marker, ms=5, mfc="none", label=f"thrown with {v0:g} m/s")
    ax.plot([], [], "k-", lw=0.8, label="Coulomb's law")
    ax.set(xlabel="coefficient of friction", ylabel="speed along the slope after landing [m/s]")
    ax.legend(loc="upper right")
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("thrown with 3 m/s, mu = 0.5:", after(0.5, 3.0), "m/s, expected", expected(0.5, 3.0))
    picture().savefig("slope-landing.png")
