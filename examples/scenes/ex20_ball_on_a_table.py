"""A ball on a table that shakes
=============================

Above: the ball bounces in step with the table, once in each of its periods, an orbit known in closed form.
Below: a softer ball chatters to rest on the table, rides along, and is thrown off where the table falls faster
than the ball would: sin(phase) = g/(A omega^2), whatever came before.

Source: P. J. Holmes, The dynamics of repeated impacts with a sinusoidally vibrating table (1982).
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate


def release_error() -> float:
    """How far the phases of all releases are from asin(g/(A omega^2)), at worst [rad]."""
    log = simulate(scenes.chattering_table(), EventDriven()).impacts
    phases = (40.0 * log.time[log.kind == Kind.RELEASE]) % (2.0 * math.pi)
    return float(abs(phases - math.asin(9.81 / (0.01 * 40.0**2))).max())


def picture() -> Figure:
    """Ball and table over time, in both cases."""
    figure = Figure(figsize=(8.5, 5.4), layout="constrained")
    cases = (scenes.ball_on_table(t_end=1.0), scenes.chattering_table(t_end=1.0))
    titles = ("r = 0.5: in step with the table", "r = 0.3: it chatters, rides along and is thrown off")
    for ax, scene, title in zip(figure.subplots(2, 1), cases, titles, strict=True):
        run = simulate(scene, EventDriven())
        t = np.unique(np.concatenate([np.linspace(0.0, 1.0, 3001), run.impacts.time]))
        ball = run.at(t)[0]
        gap = np.array([scene.gap(x, q, [0.0])[0] for x, q in zip(t, ball, strict=True)])
        ax.fill_between(t, 1e3 * (ball - gap)[:, 0], -20.0, color="0.8", label="table")
        ax.plot(t, 1e3 * ball[:, 0], lw=1.3, label="ball")
        off = run.impacts.time[run.impacts.kind == Kind.RELEASE]
        ax.plot(off, 1e3 * run.at(off)[0][:, 0], "C3^", ms=8, label="thrown off")
        ax.set(ylabel="height [mm]", xlim=(0.0, 1.0), ylim=(-14.0, None), title=title)
        ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.set_xlabel("time t [s]")
    return figure


if __name__ == "__main__":
    print(f"released within {release_error():.1e} rad of the phase of theory")
    picture().savefig("ball-on-a-table.png")
