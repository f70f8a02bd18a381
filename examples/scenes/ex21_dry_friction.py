"""An oscillator that dry friction stops
=====================================

Let go at x0, a mass on a spring loses 2 mu N/k of its amplitude in each half swing, and sticks for good at the
first turning point where friction outweighs the spring: at a place that need not be the middle. Straight lines
bound what would be an exponential with viscous damping.

Source: C. A. de Coulomb (1785); J. P. Den Hartog, Mechanical Vibrations (1934).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Moreau, simulate

DRAG = 0.1


def rest_error() -> float:
    """How far the place of rest is from -0.05 [m], where five half swings end."""
    run = simulate(scenes.coulomb_oscillator(drag=DRAG), EventDriven())
    return float(abs(run.q[-1, 0] + 0.05))


def picture() -> Figure:
    """Motions for three coefficients of friction, and the lines that bound one of them."""
    figure = Figure(figsize=(7.5, 4.4), layout="constrained")
    ax = figure.subplots()
    for drag, line in ((0.02, "C0:"), (DRAG, "C1-"), (0.25, "C2--")):
        run = simulate(scenes.coulomb_oscillator(drag=drag), Moreau(h=1e-3))
        ax.plot(run.t, run.q[:, 0], line, lw=1.5, label=f"friction {drag:g} of the weight")
    t = np.linspace(0.0, 5.0 * np.pi, 3)
    for side in (-1.0, 1.0):
        ax.plot(t, side * (1.05 - 2.0 * DRAG * t / np.pi), "k-", lw=0.7)
    ax.axhspan(-DRAG, DRAG, color="0.88", label="friction 0.1 holds the spring")
    ax.set(xlabel="time t [s]", ylabel="displacement x [m]", xlim=(0.0, 20.0), ylim=(-1.1, 1.7))
    ax.legend(loc="upper right", ncols=2)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"it rests within {rest_error():.1e} m of the exact place")
    picture().savefig("dry-friction.png")
