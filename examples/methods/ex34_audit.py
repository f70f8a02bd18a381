"""An impact that nobody noticed
=============================

A ball is thrown over a needle of a tenth of a millimetre, which stands in its way. An event-driven run looks at
gaps at times, and here flies through. With `audit=True` the finished motion is searched by interval arithmetic:
what cannot be shown to be free of a touch is looked at more closely, and the impact that was missed is taken.

Source: R. E. Moore, Interval Analysis (1966); docs/accuracy.md says what is certified.
"""

import math

import numpy as np
from matplotlib.figure import Figure

from lagrangian import Contacts, Scene, System
from lcpstep import EventDriven, Trajectory, simulate


def force(t, q, v, p, out):
    out[0], out[1] = 0.0, -9.81


def gap(t, q, v, p, out):
    s = (q[0] - p[0]) / p[1]
    out[0] = q[1] - p[2] * math.exp(-s * s)


def jacobian(t, q, v, p, out):
    s = (q[0] - p[0]) / p[1]
    out[0, 0], out[0, 1] = 2.0 * s / p[1] * p[2] * math.exp(-s * s), 1.0


def throw(audit: bool) -> Trajectory:
    """A ball of 1 kg above flat ground with a needle at 0.83 m, 0.3 m high."""
    needle = {"place": 0.83, "width": 1e-4, "height": 0.3}
    scene = Scene(
        system=System(n_q=2, mass=[[1.0, 0.0], [0.0, 1.0]], force=force),
        contacts=Contacts(n_c=1, gap=gap, jacobian=jacobian, restitution=0.7),
        q0=[0.0, 0.05],
        v0=[2.0, 1.9],
        t_span=(0.0, 0.8),
        parameters=needle,
        name="ball and needle",
    )
    return simulate(scene, EventDriven(audit=audit))


def picture() -> Figure:
    """The two paths."""
    figure = Figure(figsize=(8.0, 3.8), layout="constrained")
    ax = figure.subplots()
    t = np.linspace(0.0, 0.8, 2001)
    for audit, style, name in ((False, "C1--", "EventDriven()"), (True, "C0-", "EventDriven(audit=True)")):
        ax.plot(*throw(audit).at(t)[0].T, style, lw=1.6, label=name)
    ax.plot(
        [0.0, 0.83, 0.83, 0.83, 1.6], [0.0, 0.0, 0.3, 0.0, 0.0], color="0.3", lw=2.0, label="ground, needle"
    )
    ax.set(xlabel="x [m]", ylabel="height y [m]", xlim=(0.0, 1.6), ylim=(-0.01, 0.32))
    ax.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), frameon=False)
    ax.grid(alpha=0.3)
    return figure


if __name__ == "__main__":
    print(throw(audit=True).audit)
    picture().savefig("audit.png")
