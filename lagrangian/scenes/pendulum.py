"""A pendulum that strikes a stop at its lowest point: theta'' = -(g/L) sin theta, theta >= 0.

Flight j is an arc of a pendulum of modulus k_j = r^j sin(theta0/2) and lasts 2 K(k_j) sqrt(L/g) (half as long the
first): theta = 2 asin(k sn(w tau, k)). The same as a point on a rod: x = L sin theta, y = -L cos theta with the
joint x^2 + y^2 = L^2, whose tension is m (L theta'^2 + g cos theta). Source: E. T. Whittaker, Analytical Dynamics,
section 44. What usually goes wrong: the joint drifts; joint and contact impulses are not solved for together.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.joints import Joints
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem, System


def pendulum_force(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Moment of the weight; p = (L, g) for a unit mass."""
    out[0] = -p[0] * p[1] * math.sin(q[0])


def pendulum_force_q(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    out[0, 0] = -p[0] * p[1] * math.cos(q[0])


def no_damping(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Derivative in the velocity."""
    out[0, 0] = 0.0


def rod(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Joint (x^2 + y^2 - L^2) / (2 L), near zero the stretch of the rod: its multiplier is minus the tension."""
    out[0] = (q[0] * q[0] + q[1] * q[1] - p[0] * p[0]) / (2.0 * p[0])


def rod_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its derivative."""
    out[0, 0], out[0, 1] = q[0] / p[0], q[1] / p[0]


def rod_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Its second derivative at v' = 0."""
    out[0] = (v[0] * v[0] + v[1] * v[1]) / p[0]


@checked
def pendulum_stop(
    theta0: float = 1.0,
    length: float = 1.0,
    g: float = 9.81,
    restitution: float = 0.8,
    form: str = "angle",
    t_end: float = 5.0,
) -> Scene:
    """Pendulum of 1 kg let go at the angle theta0 [rad] above a stop; form "angle", or "rod": a point on a rod."""
    checks.positive("length", length)
    checks.positive("g", g)
    if not 0.0 < checks.number("theta0", theta0) < math.pi:
        raise ValueError(f"theta0: expected an angle in (0, pi), got {theta0!r}")
    motion = stopped_pendulum(theta0, math.sqrt(g / length), restitution)
    common: dict[str, Any] = {
        "t_span": (0.0, t_end),
        "p": [length, g],
        "parameters": {
            "theta0": theta0, "length": length, "g": g, "restitution": restitution, "form": form,
        },
        "name": "pendulum-stop",
    }  # fmt: skip
    if form == "angle":
        return Scene(
            system=System(1, length**2, pendulum_force, pendulum_force_q, no_damping),
            contacts=LinearContacts(G=1.0, restitution=restitution),
            q0=theta0,
            v0=0.0,
            exact=motion,
            coordinates=["angle [rad]"],
            **common,
        )
    if form != "rod":
        raise ValueError(f'form: expected "angle" or "rod", got {form!r}')

    def exact(times: Array) -> tuple[Array, Array]:
        angle, rate = motion(times)
        s, c = np.sin(angle), np.cos(angle)
        return length * np.hstack([s, -c]), length * rate * np.hstack([c, s])

    return Scene(
        system=LinearSystem(M=np.eye(2), force=Harmonic(constant=[0.0, -g])),
        contacts=LinearContacts(G=[[1.0, 0.0]], restitution=restitution),
        joints=Joints(1, rod, rod_jacobian, bias=rod_bias),
        q0=[length * math.sin(theta0), -length * math.cos(theta0)],
        v0=[0.0, 0.0],
        exact=exact,
        coordinates=["x [m]", "y [m]"],
        **common,
    )


def tension(theta: Array, rate: Array, length: float, g: float) -> Array:
    """Force in the rod of a pendulum of 1 kg [N]."""
    return length * rate**2 + g * np.cos(theta)


def stop_times(theta0: float, w0: float, restitution: float, n: int) -> Array:
    """Times of the first n impacts [s]."""
    from scipy.special import ellipk

    k = math.sin(0.5 * theta0) * restitution ** np.arange(n)
    return np.cumsum(ellipk(k**2) * np.where(np.arange(n) == 0, 1.0, 2.0)) / w0


def stopped_pendulum(theta0: float, w0: float, restitution: float) -> Callable[[Array], tuple[Array, Array]]:
    """Angle and rate of the pendulum as functions of time, each (m, 1)."""

    def motion(times: Array) -> tuple[Array, Array]:
        from scipy.special import ellipj, ellipk

        t = np.asarray(times, dtype=float)
        flights = int(max(np.max(t, initial=0.0), 0.0) * w0 / math.pi) + 2  # none is shorter than pi/w0
        hits = stop_times(theta0, w0, restitution, flights)
        j = np.searchsorted(hits, t, side="right")
        k = math.sin(0.5 * theta0) * restitution ** j.astype(float)
        began = np.where(j == 0, -ellipk(k**2) / w0, hits[np.maximum(j - 1, 0)])
        sn, cn, _, _ = ellipj(w0 * (t - began), k**2)
        resting = (j > 0) & (restitution == 0.0)
        angle = np.where(resting, 0.0, 2.0 * np.arcsin(np.clip(k * sn, 0.0, 1.0)))
        return angle[:, None], np.where(resting, 0.0, 2.0 * k * w0 * cn)[:, None]

    return motion
