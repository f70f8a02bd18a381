"""A mechanism of one's own
========================

A sphere in a bowl that moves up and down, q = (x, y), from its equations to a film: mass and force, the gap to
the bowl with its derivatives, and what it looks like. Two methods that know nothing of each other give the same
motion.

Source: the distance of a point from a circle; Newton's law of impact with a coefficient of restitution of 0.6.
"""

import math

from lagrangian import Contacts, Scene, System
from lagrangian.drawing import Circle, Line
from lcpstep import EventDriven, Moreau, simulate

GRAVITY = 9.81


def force(t, q, v, p, out):
    out[0], out[1] = 0.0, -p[0] * GRAVITY


def gap(t, q, v, p, out):
    lift = p[2] * math.sin(p[3] * t)
    out[0] = p[1] - math.sqrt(q[0] ** 2 + (q[1] - p[1] - lift) ** 2)


def jacobian(t, q, v, p, out):
    x, y = q[0], q[1] - p[1] - p[2] * math.sin(p[3] * t)
    distance = math.sqrt(x * x + y * y)
    out[0, 0], out[0, 1] = -x / distance, -y / distance


def gap_t(t, q, v, p, out):
    x, y = q[0], q[1] - p[1] - p[2] * math.sin(p[3] * t)
    out[0] = y / math.sqrt(x * x + y * y) * p[2] * p[3] * math.cos(p[3] * t)


def drawing(t, q):
    """Shapes in the plane from time and coordinates: the bowl, and the sphere whose contact 0 flashes when struck."""
    middle = 0.5 + 0.02 * math.sin(20.0 * t)
    angles = [math.pi * (1.0 + k / 40) for k in range(41)]
    wall = [(0.525 * math.cos(a), middle + 0.525 * math.sin(a)) for a in angles]
    return [Line(wall, fixed=True), Circle((q[0], q[1]), 0.025, contacts=(0,))]


def bowl() -> Scene:
    """Mass [kg], radius [m], amplitude [m] and frequency [rad/s] of the bowl are the parameters."""
    parameters = {"m": 0.2, "radius": 0.5, "amplitude": 0.02, "omega": 20.0}
    return Scene(
        system=System(n_q=2, mass=[[0.2, 0.0], [0.0, 0.2]], force=force),
        contacts=Contacts(n_c=1, gap=gap, jacobian=jacobian, gap_t=gap_t, restitution=0.6),
        q0=[0.3, 0.4],
        v0=[0.0, 0.0],
        t_span=(0.0, 2.0),
        parameters=parameters,
        period=2.0 * math.pi / parameters["omega"],
        coordinates=["x [m]", "y [m]"],
        drawing=drawing,
        name="sphere in a bowl",
    )


def distance_of_methods(h: float = 1e-4, until: float = 0.5) -> float:
    """How far apart time-stepping and the event-driven run are before `until` [m]."""
    fast = simulate(bowl(), Moreau(h=h))
    early = fast.t <= until
    q, _ = simulate(bowl(), EventDriven(rtol=1e-10, atol=1e-10)).at(fast.t[early])
    return float(abs(fast.q[early] - q).max())


if __name__ == "__main__":
    print(f"{distance_of_methods():.1e} m apart in the first half second")
    simulate(bowl(), EventDriven()).animate("own-mechanism.gif", seconds=4.0)
