"""A ball dropped on a floor: q'' = -g, q >= 0.

From rest at h0 it strikes the floor at sqrt(2 h0/g), loses the fraction 1 - r of its speed at every impact and
lies still from the accumulation time sqrt(2 h0/g) (1 + r)/(1 - r) on. What usually goes wrong: an event-driven
run stalls at the accumulation of impacts, or the ball tunnels through the floor.
"""

from __future__ import annotations

from lagrangian import checks
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.system import Harmonic, LinearSystem


def bouncing_ball(
    h0: float = 1.0, v0: float = 0.0, g: float = 9.81, restitution: float = 0.8, t_end: float = 5.0
) -> Scene:
    """Ball of 1 kg falling from height h0 [m] with velocity v0 [m/s] under gravity g [m/s^2]."""
    checks.number("g", g, least=0.0)
    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-g)),
        contacts=LinearContacts(
            G=1.0, restitution=checks.number("restitution", restitution, least=0.0, most=1.0)
        ),
        q0=checks.number("h0", h0),
        v0=checks.number("v0", v0),
        t_span=(0.0, checks.positive("t_end", t_end)),
        parameters={"h0": h0, "v0": v0, "g": g, "restitution": restitution},
        name="bouncing-ball",
    )
