"""A chaotic cam, filmed
=====================

At 660 rpm the follower never repeats itself: it is thrown off the cam and lands after one turn, two, or three.
The first second, fifteen times slower; impacts flash.

Source: G. Osorio, Complex Behavior in Impacting Systems (University of Naples), chapter 3.
"""

from lagrangian import scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate


def first_second() -> Trajectory:
    """The follower from 0.4 m above the cam."""
    return simulate(scenes.cam_follower(rpm=660.0, t_end=0.5), EventDriven())


if __name__ == "__main__":
    run = first_second()
    print("impacts at", run.impacts.time[run.impacts.kind == Kind.IMPACT].round(4), "s")
    run.animate("cam.gif", seconds=6.0, fps=20)
