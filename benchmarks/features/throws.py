"""One ball thrown over a floor, described with one more feature at a time; its motion is known in each case.

y'' = -g,  x'' = 0;    at a bounce  v_y -> -r v_y,   v_x -> v_x - mu (1 + r) |v_y|  while it still slides
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lagrangian import Contacts, Joints, LinearContacts, LinearJoints, LinearSystem, Scene, System
from lagrangian.friction import Coulomb

G, R, MU, HEIGHT, SPEED, T_END = 9.81, 0.6, 0.1, 0.5, 2.0, 1.0


@dataclass(frozen=True)
class Throw:
    """A description of the ball, its friction coefficient, and how its coordinates give (x, y)."""

    scene: Scene
    mu: float = 0.0
    projected: bool = False
    place: Callable[[np.ndarray], np.ndarray] = lambda q: q[:2]

    def error(self, q: np.ndarray) -> float:
        """Distance from the exact place at the end of the span [m]."""
        return float(np.hypot(*(self.place(q) - exact(self.scene.t_span[1], self.mu))))


def exact(t: float, mu: float) -> np.ndarray:
    """Place of the ball at time t."""
    x, y, vx, vy = 0.0, HEIGHT, SPEED, 0.0
    while True:
        fall = (vy + math.sqrt(vy * vy + 2.0 * G * y)) / G
        if fall >= t:
            return np.array([x + vx * t, y + vy * t - 0.5 * G * t * t])
        t, x, y, vy = t - fall, x + vx * fall, 0.0, vy - G * fall
        vx, vy = vx - mu * (1.0 + R) * -vy, -R * vy


def polar_mass(t, q, v, p, out):
    out[0, 0], out[1, 1] = 1.0, q[0] * q[0]
    out[0, 1] = out[1, 0] = 0.0


def polar_force(t, q, v, p, out):
    out[0] = q[0] * v[1] * v[1] - p[0] * math.sin(q[1])
    out[1] = -2.0 * q[0] * v[0] * v[1] - p[0] * q[0] * math.cos(q[1])


def polar_gap(t, q, v, p, out):
    out[0] = 1.0 + q[0] * math.sin(q[1])


def polar_jacobian(t, q, v, p, out):
    out[0, 0], out[0, 1] = math.sin(q[1]), q[0] * math.cos(q[1])


def polar_place(q):
    # the pole lies one metre above the floor and one to the left of the start
    return np.array([q[0] * math.cos(q[1]) - 1.0, 1.0 + q[0] * math.sin(q[1])])


def twin(t, q, v, p, out):
    out[0] = math.sin(q[2] - q[0])


def twin_jacobian(t, q, v, p, out):
    c = math.cos(q[2] - q[0])
    out[0, 0], out[0, 1], out[0, 2] = -c, 0.0, c


def throws() -> dict[str, Throw]:
    """All descriptions, the plain one first."""
    floor = LinearContacts([[0.0, 1.0]], restitution=R)
    rough = Coulomb(MU, [[1.0, 0.0]])
    plain = Scene(
        system=LinearSystem(M=np.eye(2), force=[0.0, -G]), contacts=floor,
        q0=[0.0, HEIGHT], v0=[SPEED, 0.0], t_span=(0.0, T_END), name="thrown ball",
    )  # fmt: skip
    wide = LinearSystem(M=np.diag([0.5, 1.0, 0.5]), force=[0.0, -G, 0.0])
    joined = replace(
        plain, system=wide, contacts=LinearContacts([[0.0, 1.0, 0.0]], restitution=R),
        joints=LinearJoints([[-1.0, 0.0, 1.0]]), q0=[0.0, HEIGHT, 0.0], v0=[SPEED, 0.0, SPEED],
    )  # fmt: skip
    start, y = math.hypot(1.0, HEIGHT - 1.0), HEIGHT - 1.0
    polar = Scene(
        system=System(2, polar_mass, polar_force), contacts=Contacts(1, polar_gap, polar_jacobian, restitution=R),
        q0=[start, math.atan2(y, 1.0)], v0=[SPEED / start, -y * SPEED / start**2], t_span=(0.0, T_END), p=[G],
        name="thrown ball, polar",
    )  # fmt: skip
    wall = LinearContacts([[0.0, 1.0], [-1.0, 0.0]], offset=[0.0, 100.0], restitution=R)
    return {
        "one contact": Throw(plain),
        "a second contact": Throw(replace(plain, contacts=wall)),
        "friction": Throw(replace(plain, contacts=replace(floor, friction=rough)), mu=MU),
        "a joint": Throw(joined),
        "a curved joint": Throw(replace(joined, joints=Joints(1, twin, twin_jacobian))),
        "projection": Throw(plain, projected=True),
        "nonlinear mass": Throw(polar, place=polar_place),
    }


def at_rest(throw: Throw) -> Scene:
    """The same description of a ball that lies on the floor, so that its contact is closed in every step."""
    s = throw.scene
    q, v = np.array(s.q0), np.zeros(s.n_q)
    if s.name.endswith("polar"):
        q = np.array([math.sqrt(2.0), -0.25 * math.pi])
    else:
        q[1] = 0.0
    return replace(s, q0=q, v0=v)
