"""A point that falls into a bowl, lands plastically and slides: x^2 + y^2 <= R^2, restitution 0.

It falls freely to the wall, loses the velocity normal to it, and from then on is a pendulum of length R with the
energy it has left: theta = 2 asin(k sn(w tau + u0, k)). Source: E. T. Whittaker, Analytical
Dynamics, section 44. What usually goes wrong: the point sinks into the wall as it slides; the normal
taken at the start of the step costs four digits.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import Contacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


def bowl_gap(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Distance to the wall; p = (R,)."""
    out[0] = p[0] - math.hypot(q[0], q[1])


def bowl_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative: the inward normal."""
    r = math.hypot(q[0], q[1])
    out[0, 0], out[0, 1] = -q[0] / r, -q[1] / r


def bowl_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Gap acceleration at v' = 0."""
    r = math.hypot(q[0], q[1])
    out[0] = -((q[0] * v[1] - q[1] * v[0]) ** 2) / r**3


@checked
def bowl(x0: float = 0.6, y0: float = 0.0, radius: float = 1.0, g: float = 9.81, t_end: float = 5.0) -> Scene:
    """Point of 1 kg let go at (x0, y0) inside a bowl of this radius [m]; it lands and slides for ever."""
    checks.positive("radius", radius)
    checks.positive("g", g)
    if not math.hypot(x0, y0) < radius or x0 == y0 == 0.0:
        raise ValueError(f"x0, y0: expected a place inside the bowl but for its centre, got {x0!r}, {y0!r}")
    bottom = -math.sqrt(radius**2 - x0**2)
    t_1 = math.sqrt(2.0 * (y0 - bottom) / g)
    theta = math.atan2(x0, -bottom)  # from the lowest point
    rate = -g * t_1 * math.sin(theta) / radius  # what is left of the velocity (0, -g t_1)
    w = math.sqrt(g / radius)
    k = math.hypot(math.sin(0.5 * theta), 0.5 * rate / w)

    def exact(times: Array) -> tuple[Array, Array]:
        from scipy.special import ellipj, ellipkinc

        t = np.asarray(times, dtype=float)
        # sn(u0) = sin(theta/2)/k, going on with the sign of the rate
        phase = math.atan2(math.sin(0.5 * theta), 0.5 * rate / w)
        sn, cn, _, _ = ellipj(w * (t - t_1) + ellipkinc(phase, k * k), k * k)
        angle, speed = 2.0 * np.arcsin(np.clip(k * sn, -1.0, 1.0)), 2.0 * k * w * cn
        s, c = np.sin(angle), np.cos(angle)
        sliding = t >= t_1
        q = np.stack(
            [np.where(sliding, radius * s, x0), np.where(sliding, -radius * c, y0 - 0.5 * g * t * t)], 1
        )
        v = np.stack(
            [np.where(sliding, radius * c * speed, 0.0), np.where(sliding, radius * s * speed, -g * t)], 1
        )
        return q, v

    return Scene(
        system=LinearSystem(M=np.eye(2), force=Harmonic(constant=[0.0, -g])),
        contacts=Contacts(1, bowl_gap, bowl_jacobian, bias=bowl_bias, restitution=0.0),
        q0=[x0, y0],
        v0=[0.0, 0.0],
        t_span=(0.0, t_end),
        p=[radius],
        parameters={"x0": x0, "y0": y0, "radius": radius, "g": g},
        name="bowl",
        coordinates=["x [m]", "y [m]"],
        exact=exact if k < 1.0 else None,
    )
