"""A block on a belt that sticks and slips
=======================================

Held by a spring, a block rides on a belt until the spring outweighs static friction; then it slips back and
sticks again. This is how a bow plays a violin string. The system has modes, "stick" and "slip", with one
surface between them, and its period is known: 2 a/belt + pi + 2 atan(belt/a), where a is how much static
friction exceeds the kinetic one.

Source: A. F. Filippov, Differential Equations with Discontinuous Righthand Sides (1988).
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate


def period_error(belt: float = 0.2, static: float = 1.0, kinetic: float = 0.6) -> float:
    """Relative error of the time between two beginnings of slip."""
    scene = scenes.stick_slip_oscillator(belt=belt, static=static, kinetic=kinetic)
    times = simulate(scene, EventDriven()).switches.time
    a = static - kinetic
    exact = 2.0 * a / belt + math.pi + 2.0 * math.atan(belt / a)
    return abs((times[-1] - times[-3]) / exact - 1.0)


def picture() -> Figure:
    """The plane of place and velocity for three speeds of the belt."""
    figure = Figure(figsize=(7.0, 4.6), layout="constrained")
    ax = figure.subplots()
    for belt, line in ((0.1, "-"), (0.3, "--"), (0.5, ":")):
        run = simulate(scenes.stick_slip_oscillator(belt=belt), EventDriven())
        t = np.linspace(run.switches.time[-3], run.switches.time[-1], 2001)
        ax.plot(*run.at(t).T[:2], line, lw=1.6, label=f"belt at {belt} m/s")
    ax.set(xlabel="place of the block [m]", ylabel="its velocity [m/s]")
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"the period is right to {period_error():.1e}")
    picture().savefig("stick-slip.png")
