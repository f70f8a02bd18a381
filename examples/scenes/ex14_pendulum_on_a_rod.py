"""A pendulum at a stop, with a joint
==================================

The same pendulum twice: as one angle, and as a point in the plane that a rigid rod holds, a joint. The second
has to find the force in the rod; where the bob strikes the stop, joint and contact take their impulses
together. Both motions agree, and the rod does not stretch.

Source: elliptic functions for the motion; m (L theta'^2 + g cos(theta)) for the force in the rod.
"""

import numpy as np
from matplotlib.figure import Figure

from lagrangian import scenes
from lcpstep import EventDriven, simulate


def both():
    """The runs as angle and on a rod."""
    method = EventDriven(rtol=1e-10, atol=1e-10)
    return [simulate(scenes.pendulum_stop(form=form, t_end=5.0), method) for form in ("angle", "rod")]


def distance() -> float:
    """How far apart the bobs of both runs are at worst [m]."""
    angle, rod = both()
    t = np.linspace(0.0, 5.0, 2001)
    theta, place = angle.at(t)[0][:, 0], rod.at(t)[0]
    return float(np.abs(place - np.stack([np.sin(theta), -np.cos(theta)], axis=1)).max())


def picture() -> Figure:
    """The angle, and the force in the rod, between impacts."""
    angle, rod = both()
    t = np.linspace(0.0, 5.0, 2001)
    theta, rate = (x[:, 0] for x in angle.at(t))
    q, _ = rod.at(t)
    figure = Figure(figsize=(8.0, 5.2), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    above.plot(t, theta, "C0-", lw=3.0, alpha=0.4, label="as an angle")
    above.plot(t, np.arctan2(q[:, 0], -q[:, 1]), "k--", lw=1.0, label="as a point on a rod")
    above.set(ylabel="angle [rad]")
    below.plot(t, rate**2 + 9.81 * np.cos(theta), "C0-", lw=1.2)
    below.set(xlabel="time t [s]", ylabel="force in the rod [N]", xlim=(0.0, 5.0))
    above.legend(loc="upper right")
    for ax in (above, below):
        ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(f"the bobs are {distance():.1e} m apart; the rod stretches by {both()[1].joint_drift[0]:.1e} m")
    picture().savefig("pendulum-on-a-rod.png")
