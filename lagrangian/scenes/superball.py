"""A superball: a rough ball that keeps its energy in the impact, sliding velocity and all.

    u = v + R w,   u+ = -u-  on normal and tangent:   v+ = v - k u,   R w+ = R w - (k/beta) u,   k = 2 beta/(1 + beta)

with beta = I/(m R^2). This map of (v, R w) is its own inverse: two bounces give back velocity and spin. Thrown
without spin the ball goes on slower and spinning, then as before; with R w = v/beta each bounce reverses both, and it
jumps to and fro over one place. Where friction does not suffice for that, the ball slides through the impact, and
loses 2 mu v_N of its velocity. Source: R. L. Garwin, Kinematics of an ultraelastic rough ball, American Journal of
Physics 37 (1969) 88. What usually goes wrong: no restitution on the tangent, or friction as a force of a step.
"""

from __future__ import annotations

import math

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


@checked
def superball(
    v0: float = 1.0,
    spin: float = 0.0,
    height: float = 0.5,
    mu: float = 1.0,
    beta: float = 0.4,
    radius: float = 0.03,
    g: float = 9.81,
    t_end: float = 5.0,
) -> Scene:
    """Ball of 1 kg thrown over a floor with v0 [m/s] and `spin` [rad/s]; it bounces without losing energy.

    The coordinates are x, height, and angle (counted so that the ball slides with x' + R angle').

    Parameters
    ----------
    beta : moment of inertia over m R^2: 2/5 for a solid ball
    height : from which it falls [m]
    """
    for name, value in (("height", height), ("mu", mu), ("beta", beta), ("radius", radius), ("g", g)):
        checks.positive(name, value)
    fall = math.sqrt(2.0 * height / g)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        flights = np.floor((t + fall) / (2.0 * fall)).astype(int)  # number of bounces so far
        v, rim = bounces(v0, radius * spin, int(np.max(flights, initial=0)), g * fall, mu, beta)
        start = np.maximum((2.0 * flights - 1.0) * fall, 0.0)
        tau, lengths = t - start, np.where(np.arange(len(v)) == 0, fall, 2.0 * fall)
        x, turned = (np.concatenate([[0.0], np.cumsum(rate * lengths)[:-1]]) for rate in (v, rim))
        up = np.where(flights == 0, 0.0, g * fall)
        y = np.where(flights == 0, height, 0.0) + tau * (up - 0.5 * g * tau)
        q = [x[flights] + v[flights] * tau, y, (turned[flights] + rim[flights] * tau) / radius]
        return np.stack(q, axis=1), np.stack([v[flights], up - g * tau, rim[flights] / radius], axis=1)

    return Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, beta * radius**2]), force=Harmonic(constant=[0.0, -g, 0.0])),
        contacts=LinearContacts(
            G=[[0.0, 1.0, 0.0]], restitution=1.0, friction=Coulomb(mu, [[1.0, 0.0, radius]])
        ),
        q0=[0.0, height, 0.0],
        v0=[v0, 0.0, spin],
        t_span=(0.0, t_end),
        parameters={
            "v0": v0, "spin": spin, "height": height, "mu": mu, "beta": beta, "radius": radius, "g": g
        },
        name="superball",
        exact=exact,
        coordinates=["x [m]", "height [m]", "angle [rad]"],
    )  # fmt: skip


def bounces(v: float, rim: float, n: int, v_N: float, mu: float, beta: float) -> tuple[Array, Array]:
    """Velocity and R w, (n + 1,) each: thrown, and after each of n bounces that arrive with v_N."""
    states = [(v, rim)]
    for _ in range(n):
        v, rim = states[-1]
        wanted = (
            2.0 * beta / (1.0 + beta) * (v + rim)
        )  # impulse of friction that returns the sliding velocity
        impulse = math.copysign(min(abs(wanted), 2.0 * mu * v_N), wanted)
        states.append((v - impulse, rim - impulse / beta))
    after = np.array(states)
    return after[:, 0], after[:, 1]
