"""Painleve's rod: where rigid bodies and dry friction contradict each other
=========================================================================

A rod slides on its lower tip, leaning the way it moves away from. From a coefficient of friction on that
depends on the angle, and never below 4/3, no contact force keeps the tip above the floor, or two do. The run
says so by name and does not make one up.

Source: P. Painleve, Comptes Rendus 121 (1895) 112; F. Genot, B. Brogliato (1999).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate


def critical(angle: np.ndarray | float) -> np.ndarray | float:
    """Coefficient of friction from which on the paradox begins."""
    return (1.0 + 3.0 * np.cos(angle) ** 2) / (3.0 * np.sin(angle) * np.cos(angle))


def status(mu: float, angle: float) -> str:
    """How a run from this angle ends."""
    return simulate(scenes.falling_rod(mu=mu, angle=angle, t_end=1e-3), EventDriven(1e-9, 1e-9)).status.name


def picture() -> Figure:
    """The critical coefficient over the angle, and runs on both sides of it."""
    figure = Figure(figsize=(7.5, 4.6), layout="constrained")
    ax = figure.subplots()
    fine = np.linspace(0.3, 1.45, 400)
    ax.plot(fine, critical(fine), "k-", label="theory")
    ax.axhline(4.0 / 3.0, color="0.5", ls=":", label="4/3")
    looks = {"DONE": ("C0o", "moves on"), "PAINLEVE_INCONSISTENT": ("C3X", "no contact force"),
             "PAINLEVE_INDETERMINATE": ("C1P", "two contact forces")}  # fmt: skip
    found = [(a, mu, status(mu, a)) for a in np.linspace(0.4, 1.4, 11) for mu in np.linspace(0.5, 2.75, 10)]
    for name, (style, words) in looks.items():
        own = [(a, mu) for a, mu, end in found if end == name]
        if own:
            ax.plot(*np.transpose(own), style, ms=6, label=words)
    ax.set(xlabel="angle of the rod above the floor [rad]", ylabel="coefficient of friction", ylim=(0.3, 3.0))
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("at 1 rad:", {mu: status(mu, 1.0) for mu in (1.0, 1.35, 1.4, 2.0)}, "critical:", critical(1.0))
    picture().savefig("painleve-rod.png")
