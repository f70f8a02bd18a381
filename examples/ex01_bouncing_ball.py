"""A ball that comes to rest
=========================

A ball dropped on a floor bounces infinitely often in a finite time. The event-driven run takes the whole
sequence in one piece, and knows when it ends: at sqrt(2 h0/g) (1 + r)/(1 - r), to the last digits.

Source: any textbook of mechanics; each bounce takes r times as long as the one before.
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate


def accumulation_error(restitution: float = 0.8) -> float:
    """Relative error of the time at which the ball comes to rest."""
    ball = simulate(scenes.bouncing_ball(restitution=restitution), EventDriven())
    found = ball.impacts.time[ball.impacts.kind == Kind.ACCUMULATION][0]
    exact = math.sqrt(2.0 / 9.81) * (1.0 + restitution) / (1.0 - restitution)
    return abs(found / exact - 1.0)


def picture() -> Figure:
    """Height over time for three coefficients of restitution, each with the time at which it rests."""
    figure = Figure(figsize=(7.5, 4.2), layout="constrained")
    ax = figure.subplots()
    t = np.linspace(0.0, 5.0, 4001)
    for restitution, line in ((0.8, "-"), (0.65, "--"), (0.5, ":")):
        ball = simulate(scenes.bouncing_ball(restitution=restitution), EventDriven())
        rest = ball.impacts.time[ball.impacts.kind == Kind.ACCUMULATION][0]
        curve = ax.plot(
            t, ball.at(t)[0][:, 0], line, lw=1.3, label=f"r = {restitution}, rests at {rest:.4f} s"
        )
        ax.plot(rest, 0.0, "v", color=curve[0].get_color(), ms=8, clip_on=False)
    ax.set(xlabel="time t [s]", ylabel="height [m]", xlim=(0.0, 5.0), ylim=(0.0, 1.05))
    ax.legend(loc="upper right")
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print("relative error of the time of rest:", accumulation_error())
    picture().savefig("bouncing-ball.png")
