"""A ball comes to rest after infinitely many impacts; the event-driven run knows when."""

import math

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate


def accumulation_error(restitution: float = 0.8) -> float:
    """Relative error of the time at which the ball comes to rest."""
    ball = simulate(scenes.bouncing_ball(restitution=restitution), EventDriven())
    found = ball.impacts.time[ball.impacts.kind == Kind.ACCUMULATION][0]
    exact = math.sqrt(2.0 / 9.81) * (1.0 + restitution) / (1.0 - restitution)
    return abs(found / exact - 1.0)


if __name__ == "__main__":
    from lcpstep.plot.motion import overview

    print("relative error of the accumulation time:", accumulation_error())
    overview(simulate(scenes.bouncing_ball(), EventDriven())).savefig("bouncing-ball.png")
