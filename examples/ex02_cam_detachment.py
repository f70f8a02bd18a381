"""When a follower leaves its cam
==============================

A spring presses a follower on a turning cam. Above some speed the cam falls away faster than the spring can
follow. That speed is found here by asking the simulation, by bisection; theory has 114.979 rpm, where the cam's
acceleration is -(k/m) times its lift.

Source: G. Osorio, Complex Behavior in Impacting Systems (University of Naples), chapter 4.
"""

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import bisect

from lagrangian import scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate


def two_turns(rpm: float, keep: str | int = "impacts") -> Trajectory:
    """A follower that rests on the cam at the start, for two turns."""
    scene = scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0, t_end=120.0 / rpm)
    return simulate(scene, EventDriven(), keep=keep)


def leaves_the_cam(rpm: float) -> bool:
    """Whether it is released within two turns."""
    return Kind.RELEASE in two_turns(rpm).impacts.kind


def detachment_speed(low: float = 100.0, high: float = 130.0, digits: float = 1e-9) -> float:
    """First detachment [rpm]."""
    return bisect(lambda rpm: 1.0 if leaves_the_cam(rpm) else -1.0, low, high, rtol=digits)


def picture() -> Figure:
    """The largest gap within two turns over the speed, and the two sequences of bounces of each turn at 126 rpm."""
    figure = Figure(figsize=(8.0, 5.6), layout="constrained")
    above, below = figure.subplots(2, 1)
    speeds = np.linspace(112.0, 130.0, 73)
    largest = [1e3 * max(two_turns(rpm, keep=1).q[:, 0]) for rpm in speeds]
    above.plot(speeds, largest, "k.-", ms=4, lw=0.8)
    above.axvline(114.979327, color="C3", ls="--", label="theory: 114.979 rpm")
    above.set(xlabel="speed of the cam [rpm]", ylabel="largest gap [mm]", xlim=(112.0, 130.0))
    above.legend(loc="upper left")
    turns = np.linspace(0.15, 0.36, 6001)
    q, _ = two_turns(126.0, keep=1).at(turns * 60.0 / 126.0)
    below.plot(turns, 1e3 * q[:, 0], lw=1.2)
    below.set(xlabel="turns of the cam", ylabel="gap at 126 rpm [mm]", xlim=(0.15, 0.36), ylim=(0.0, None))
    for ax in (above, below):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"the follower first leaves the cam at {detachment_speed():.6f} rpm")
    picture().savefig("cam-detachment.png")
