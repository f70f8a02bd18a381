"""A double pendulum against a wall, filmed
========================================

Two rods let go; the tip strikes a wall. Built in as angles and as four coordinates with two rigid rods, both
the same motion: joints, contacts and moving masses in one scene. Impacts flash.

Source: any textbook on mechanics; the states are known to 40 digits by Taylor series.
"""

import numpy as np

from lagrangian import scenes
from lcpstep import EventDriven, Trajectory, simulate


def motion(form: str = "rods") -> Trajectory:
    """Three seconds, as "angles" or as "rods"."""
    return simulate(scenes.double_pendulum(form=form), EventDriven(rtol=1e-10, atol=1e-10))


def distance(until: float = 2.0) -> float:
    """How far apart the tips are in both descriptions [m]."""
    t = np.linspace(0.0, until, 400)
    a, rods = motion("angles").at(t)[0], motion().at(t)[0]
    tip = np.stack([np.sin(a).sum(axis=1), -np.cos(a).sum(axis=1)], axis=1)
    return float(np.abs(rods[:, 2:] - tip).max())


if __name__ == "__main__":
    print(f"the tips are {distance():.1e} m apart")
    motion().animate("double-pendulum.gif", seconds=5.0, fps=20)
