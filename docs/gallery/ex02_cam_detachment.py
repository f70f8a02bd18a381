"""The speed at which the follower first leaves the cam, found from the simulation by bisection."""

from scipy.optimize import bisect

from lagrangian import scenes
from lcpstep import EventDriven, Kind, simulate


def leaves_the_cam(rpm: float) -> bool:
    """Whether a follower that rests on the cam is released within two turns."""
    scene = scenes.cam_follower(rpm=rpm, q0=0.0, v0=0.0, t_end=120.0 / rpm)
    return Kind.RELEASE in simulate(scene, EventDriven(), keep="impacts").impacts.kind


def detachment_speed(low: float = 100.0, high: float = 130.0, digits: float = 1e-9) -> float:
    """First detachment [rpm]."""
    return bisect(lambda rpm: 1.0 if leaves_the_cam(rpm) else -1.0, low, high, rtol=digits)


if __name__ == "__main__":
    print(f"the follower first leaves the cam at {detachment_speed():.6f} rpm")
