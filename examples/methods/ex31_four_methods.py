"""Four methods, one motion
========================

An oscillator that strikes a stop, by plain Moreau steps, by steps with located impacts of order 2 and 4, and
event by event. The first places an impact at the end of a step, the next two at its own time; the last has a
closed form from impact to impact. All for steps of 0.05 s, against the exact motion.

Source: J. J. Moreau (1988); V. Acary, B. Brogliato, Numerical Methods for Nonsmooth Dynamical Systems (2008).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Located, Moreau, simulate

METHODS = {
    "Moreau": Moreau(h=0.05),
    "Located, order 2": Located(h=0.05),
    "Located, order 4": Located(h=0.05, order=4),
    "EventDriven": EventDriven(),
}


def errors(t: np.ndarray) -> dict[str, np.ndarray]:
    """Errors of the position at these times, by method [m]."""
    scene = scenes.impact_oscillator(t_end=30.0)
    exact = scene.exact(t)[0][:, 0]
    return {name: np.abs(simulate(scene, m).at(t)[0][:, 0] - exact) for name, m in METHODS.items()}


def picture() -> Figure:
    """The motion, and the errors on a logarithmic scale."""
    t = np.linspace(0.0, 30.0, 1500)
    figure = Figure(figsize=(8.5, 5.6), layout="constrained")
    motion, error = figure.subplots(2, 1, sharex=True, height_ratios=[1.0, 1.7])
    motion.plot(t, scenes.impact_oscillator(t_end=30.0).exact(t)[0], "k-", lw=1.1)
    motion.axhline(0.0, color="0.5", lw=2.0)
    motion.set(ylabel="position [m]")
    for (name, e), line in zip(errors(t).items(), ("-", "--", "-.", ":"), strict=True):
        error.semilogy(t, np.maximum(e, 1e-17), line, lw=1.2, label=name)
    error.set(xlabel="time t [s]", ylabel="error of the position [m]", xlim=(0.0, 30.0), ylim=(1e-17, 1.0))
    error.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    for ax in (motion, error):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print({name: f"{e.max():.1e} m" for name, e in errors(np.linspace(0.0, 30.0, 1500)).items()})
    picture().savefig("four-methods.png")
