"""A chain of springs flies against a wall
=======================================

Forty springs strike a wall with their first mass. A wave of compression runs through the chain, is thrown back
at its free end, and when it is back the chain leaves the wall: contact lasts two lengths over the speed of
sound. Nothing is lost in the long run, for `Located` keeps the energy of the springs.

Source: J. D. Achenbach, Wave Propagation in Elastic Solids (1973); modes in closed form.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import Located, Trajectory, simulate

N = 40


def flight() -> Trajectory:
    """The chain until it is off the wall again."""
    return simulate(scenes.elastic_chain(n=N, t_end=4.0), Located(h=1e-4), keep=40)


def largest_error() -> float:
    """Distance from the modes, summed [m], while the first mass is on the wall for the first time."""
    run = flight()
    early = run.t < 1.0
    exact, _ = run.scene.exact(run.t[early])
    return float(np.abs(run.q[early] - exact).max())


def picture() -> Figure:
    """Strain over time and place: bright where the chain is compressed."""
    run = flight()
    strain = N * np.diff(run.q, axis=1)
    figure = Figure(figsize=(8.0, 4.6), layout="constrained")
    ax = figure.subplots()
    most = float(np.abs(strain).max())
    image = ax.pcolormesh(
        run.t, (np.arange(N) + 0.5) / N, strain.T, cmap="cividis_r", vmin=-most, vmax=most, rasterized=True
    )
    figure.colorbar(image, ax=ax, label="strain [-], negative: compressed")
    ax.set(xlabel="time t [s]", ylabel="place along the chain, the wall at 0")
    return figure


if __name__ == "__main__":
    print(f"at most {largest_error():.1e} m from the exact modes")
    picture().savefig("chain-at-a-wall.png", dpi=110)
