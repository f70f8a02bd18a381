"""Newton's cradle, touching and apart
===================================

Three equal elastic balls; the first strikes the other two. Apart by a hair, one impact follows the other and
the last ball alone flies on. Touching, Newton's law for both contacts at once sends the first ball back and the
others on together: (-1/3, 2/3, 2/3). Both keep momentum and energy; what happens is a matter of the law, and
the library says which it takes.

Source: C. Glocker, Set-Valued Force Laws (Springer 2001).
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate


def last_velocities(spacing: float) -> np.ndarray:
    """Velocities of the three balls after all impacts [m/s]."""
    return simulate(scenes.newtons_cradle(spacing=spacing), EventDriven()).v[-1]


def picture() -> Figure:
    """Positions over time, apart on the left, touching on the right."""
    figure = Figure(figsize=(8.0, 4.2), layout="constrained")
    axes = figure.subplots(1, 2, sharey=True)
    for ax, spacing, title in zip(axes, (0.05, 0.0), ("5 cm apart", "touching"), strict=True):
        run = simulate(scenes.newtons_cradle(spacing=spacing), EventDriven())
        t = np.unique(np.concatenate([np.linspace(*run.scene.t_span, 500), run.impacts.time]))
        for k, (x, line) in enumerate(zip(run.at(t)[0].T, ("-", "--", ":"), strict=True)):
            ax.plot(t, x, line, lw=1.8, label=f"ball {k + 1}")
        v = ", ".join(f"{x:.3g}" for x in run.v[-1])
        ax.set(title=f"{title}: ({v}) m/s at the end", xlabel="time t [s]")
        ax.title.set_fontsize(10)
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("position [m]")
    axes[0].legend(loc="upper left")
    return figure


if __name__ == "__main__":
    print("apart:", last_velocities(0.05), " touching:", last_velocities(0.0))
    picture().savefig("newtons-cradle.png")
