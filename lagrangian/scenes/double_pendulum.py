"""A double pendulum whose tip meets a wall: two unit masses on unit rods, gravity 9.81 m/s^2, sin a + sin b <= wall.

    2 a'' + cos(a - b) b'' + sin(a - b) b'^2 + 2 g sin a = 0,   cos(a - b) a'' + b'' - sin(a - b) a'^2 + g sin b = 0

with the angles a, b of both rods from the vertical. The same as two points on rods: their coordinates x1, y1, x2, y2
with the joints x1^2 + y1^2 = 1 and (x2 - x1)^2 + (y2 - y1)^2 = 1, and a flat wall. What usually goes wrong: the mass
matrix is taken at the wrong point, and the order is lost; the rods drift.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.joints import Joints
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem, System

# Of the default scene, by Taylor series of order 30 in arithmetic of 40 digits (mpmath), impacts by Newton's method;
# tests/lagrangian/reference_double_pendulum.py computes them again.
REFERENCE_IMPACTS = np.array([0.6985040770251998, 2.0356089310940444])
REFERENCE_TIMES = np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0])
REFERENCE_STATES = np.array(  # a, b, a', b'
    [
        [-0.34020240315987094, -0.6747245653963688, 1.729871609596587, 2.9142006209385096],
        [0.03773994213927668, -1.0453544580848098, -0.8987555671883788, -1.7744396315054047],
        [-0.6665088450615059, -0.5513804630006979, -1.3665582002370544, 3.050941491334296],
        [-0.056720483533706484, -0.019273518144671414, 3.3880648448274675, -1.2635198777858527],
        [0.5327668125759751, -0.8983635706274894, -0.6085593827679079, 0.43294754422146653],
        [-0.5143231475715077, 0.4971547807851827, -1.4876701424469458, 2.350499496845936],
    ]
)


def mass(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """M."""
    out[0, 0], out[1, 1] = 2.0, 1.0
    out[0, 1] = out[1, 0] = math.cos(q[0] - q[1])


def force(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """F - N; p = (g, wall)."""
    s = math.sin(q[0] - q[1])
    out[0] = -s * v[1] * v[1] - 2.0 * p[0] * math.sin(q[0])
    out[1] = s * v[0] * v[0] - p[0] * math.sin(q[1])


def wall_gap(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Distance of the tip from the wall."""
    out[0] = p[1] - math.sin(q[0]) - math.sin(q[1])


def wall_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    out[0, 0], out[0, 1] = -math.cos(q[0]), -math.cos(q[1])


def wall_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gap acceleration at v' = 0."""
    out[0] = math.sin(q[0]) * v[0] * v[0] + math.sin(q[1]) * v[1] * v[1]


def rods(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Stretch of both rods, near zero."""
    dx, dy = q[2] - q[0], q[3] - q[1]
    out[0] = 0.5 * (q[0] * q[0] + q[1] * q[1] - 1.0)
    out[1] = 0.5 * (dx * dx + dy * dy - 1.0)


def rods_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    for i in range(2):
        out[0, i], out[0, 2 + i] = q[i], 0.0
        out[1, i], out[1, 2 + i] = q[i] - q[2 + i], q[2 + i] - q[i]


def rods_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its second derivative at v' = 0."""
    dx, dy = v[2] - v[0], v[3] - v[1]
    out[0], out[1] = v[0] * v[0] + v[1] * v[1], dx * dx + dy * dy


def as_points(states: Array) -> Array:
    """Both points' coordinates and velocities (m, 8) from a, b, a', b' (m, 4)."""
    a, b, da, db = states.T
    x, y = np.sin(a), -np.cos(a)
    vx, vy = da * np.cos(a), da * np.sin(a)
    return np.stack(
        [x, y, x + np.sin(b), y - np.cos(b), vx, vy, vx + db * np.cos(b), vy + db * np.sin(b)], axis=1
    )


@checked
def double_pendulum(
    a: float = -1.0,
    b: float = -1.2,
    wall: float = 0.0,
    restitution: float = 0.7,
    g: float = 9.81,
    form: str = "angles",
    t_end: float = 3.0,
) -> Scene:
    """Double pendulum let go at the angles a, b [rad], whose tip strikes the wall x = `wall` [m].

    form: "angles", or "rods": two points on rods.
    """
    common: dict[str, Any] = {
        "t_span": (0.0, t_end),
        "p": [checks.positive("g", g), wall],
        "parameters": {"a": a, "b": b, "wall": wall, "restitution": restitution, "g": g, "form": form},
        "name": "double-pendulum",
    }
    if form == "rods":
        return Scene(
            system=LinearSystem(M=np.eye(4), force=Harmonic(constant=[0.0, -g, 0.0, -g])),
            contacts=LinearContacts(G=[[0.0, 0.0, -1.0, 0.0]], offset=wall, restitution=restitution),
            joints=Joints(2, rods, rods_jacobian, bias=rods_bias),
            q0=as_points(np.array([[a, b, 0.0, 0.0]]))[0, :4],
            v0=np.zeros(4),
            coordinates=["x1 [m]", "y1 [m]", "x2 [m]", "y2 [m]"],
            **common,
        )
    if form != "angles":
        raise ValueError(f'form: expected "angles" or "rods", got {form!r}')
    return Scene(
        system=System(2, mass, force),
        contacts=Contacts(
            1,
            wall_gap,
            wall_jacobian,
            bias=wall_bias,
            restitution=restitution,
        ),
        q0=[a, b],
        v0=[0.0, 0.0],
        coordinates=["angle 1 [rad]", "angle 2 [rad]"],
        **common,
    )
