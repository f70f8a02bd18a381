"""A gas on a line, and one that collapses
=======================================

Left: twelve equal elastic beads between two walls. Two that meet swap their velocities, so that their lines in
space and time pass straight through each other: what looks like chaos is solved by sorting. Right: three
inelastic balls whose collisions follow ever faster, infinitely many, until all touch.

Sources: L. Tonks (1936); P. Constantin, E. Grossman, M. Mungan, Inelastic collisions of three particles on a
line (1995).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate


def distance_from_sorting() -> float:
    """How far the beads are from free flights, reflected at the walls and sorted [m]."""
    run = simulate(scenes.elastic_gas(), EventDriven())
    exact, _ = run.scene.exact(run.t)
    return float(np.abs(run.q - exact).max())


def picture() -> Figure:
    """Places over time."""
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    axes = figure.subplots(1, 2)
    made = (scenes.elastic_gas(t_end=1.0), scenes.inelastic_collapse(t_end=4.0))
    for ax, scene, title in zip(axes, made, ("elastic gas", "inelastic collapse, r = 0.05"), strict=True):
        run = simulate(scene, EventDriven())
        t = np.unique(np.concatenate([np.linspace(*scene.t_span, 400), run.impacts.time]))
        ax.plot(run.at(t)[0], t, "C0-", lw=1.0)
        log = run.impacts[run.impacts.kind == Kind.IMPACT]
        q = run.at(log.time)[0]
        beads = np.maximum(log.contact - (scene.n_c > scene.n_q), 0)
        ax.plot(q[np.arange(len(q)), beads], log.time, "k.", ms=4)
        ax.set(title=f"{title}: {len(log)} collisions", xlabel="place [m]", ylabel="time t [s]")
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"{distance_from_sorting():.1e} m from free flights, sorted")
    picture().savefig("gas-between-walls.png")
