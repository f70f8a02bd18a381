"""A block that rocks from corner to corner without sliding (Housner): half width b, half height h, R^2 = b^2 + h^2.

    phi'' = -p^2 sin(alpha - phi),   phi = |theta| >= 0,   p^2 = 3 g/(4 R),   tan(alpha) = b/h

Each impact leaves the part r = 1 - 3/2 sin^2(alpha) of the rate; the impacts accumulate, and the block stands still
after a finite time. With psi = alpha - phi a flight is cos(psi/2) = k cd(p s, k), s from its highest point. Source:
G. W. Housner, The behavior of inverted pendulum structures during earthquakes, Bull. Seism. Soc. Am. 53 (1963).
What usually goes wrong: treating both corners at once kills the rocking; the energy grows; the impacts never end.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem, System

FLIGHTS = 4000  # more than any block slender enough to rock makes before its flights fall below rounding
SWING = 1001  # angles at which the friction needed is looked for
SMALLEST = 1e-17  # rate, relative to the first, at which it stands


def righting(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """phi'' = -p^2 sin(alpha - phi); p = (p^2, alpha)."""
    out[0] = -p[0] * math.sin(p[1] - q[0])


def corner_gaps(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Heights of the lower corners, left and right; q = (x, y, theta) of the middle, p = (b, h)."""
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0] = q[1] - p[0] * s - p[1] * c
    out[1] = q[1] + p[0] * s - p[1] * c


def corner_jacobian(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Their derivatives."""
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0, 0], out[0, 1], out[0, 2] = 0.0, 1.0, -p[0] * c + p[1] * s
    out[1, 0], out[1, 1], out[1, 2] = 0.0, 1.0, p[0] * c + p[1] * s


def corner_bias(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Their accelerations at v' = 0."""
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0] = (p[0] * s + p[1] * c) * v[2] * v[2]
    out[1] = (-p[0] * s + p[1] * c) * v[2] * v[2]


def corner_tangent(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """Sliding velocities of the corners along the floor."""
    s, c = math.sin(q[2]), math.cos(q[2])
    out[0, 0], out[0, 1], out[0, 2] = 1.0, 0.0, p[0] * s + p[1] * c
    out[1, 0], out[1, 1], out[1, 2] = 1.0, 0.0, -p[0] * s + p[1] * c


@checked
def rocking_block(
    b: float = 0.1,
    h: float = 0.4,
    theta0: float = 0.15,
    g: float = 9.81,
    mu: float = 10.0,
    form: str = "angle",
    t_end: float = 6.0,
) -> Scene:
    """Block let go at the angle theta0 [rad]; form "angle": |theta| alone, or "corners": two corners with friction.

    Parameters
    ----------
    b, h : half width and half height [m]
    mu : friction of the corners, for the form "corners"; from `friction_needed` on they do not slide, and the motion
        is known in closed form
    """
    alpha, R = math.atan2(b, h), math.hypot(b, h)
    if not (b > 0.0 and h > 0.0 and g > 0.0):
        raise ValueError(f"b, h, g: expected positive numbers, got {b!r}, {h!r}, {g!r}")
    if not 0.0 < theta0 < alpha:
        raise ValueError(f"theta0: expected an angle in (0, {alpha:.6g}), got {theta0!r}")
    p2, r = 0.75 * g / R, impact_ratio(b, h)
    if r < 0.0:
        raise ValueError(f"b: expected a block that rocks, 3/2 sin^2(alpha) < 1, got b = {b!r}, h = {h!r}")
    rocking = rocking_motion(theta0, alpha, math.sqrt(p2), r)
    common: dict[str, Any] = {
        "t_span": (0.0, t_end),
        "parameters": {"b": b, "h": h, "theta0": theta0, "g": g, "mu": mu, "form": form},
        "name": "rocking-block",
    }

    def magnitude(times: Array) -> tuple[Array, Array]:
        theta, rate = rocking(times)
        return np.abs(theta)[:, None], np.where(theta < 0.0, -rate, rate)[:, None]

    if form == "angle":
        return Scene(
            system=System(1, 1.0, righting),
            contacts=LinearContacts(G=1.0, restitution=r),
            q0=theta0,
            v0=0.0,
            p=[p2, alpha],
            exact=magnitude,
            coordinates=["size of the angle [rad]"],
            **common,
        )
    if form != "corners":
        raise ValueError(f'form: expected "angle" or "corners", got {form!r}')

    def exact(times: Array) -> tuple[Array, Array]:
        theta, rate = rocking(times)
        side = np.where(theta >= 0.0, -b, b)  # of the corner that it turns about
        s, c = np.sin(theta), np.cos(theta)
        across, up = -side * c - h * s, -side * s + h * c
        q = np.stack([side + across, up, theta], axis=1)
        return q, np.stack([-up * rate, across * rate, rate], axis=1)

    start = [x[0] for x in exact(np.zeros(1))]
    known = exact if mu > friction_needed(theta0, b, h) else None
    return _on_corners(b, h, g, mu, start, exact=known, **common)


@checked
def sliding_rocking_block(
    b: float = 0.1,
    h: float = 0.4,
    theta0: float = 0.15,
    v0: float = 0.3,
    mu: float = 0.15,
    g: float = 9.81,
    t_end: float = 2.0,
) -> Scene:
    """Block let go at the angle theta0 [rad] while its corner slides with v0 [m/s]; it rocks, slides and sticks.

    Until its corner stops, or it stands, the normal force follows from the angle: two equations are left. Its impacts
    obey Moreau's law, without restitution. Source of the model: H. Yim, A. Chopra, J. Penzien, Rocking response of
    rigid blocks to earthquakes, Earthquake Engineering and Structural Dynamics 8 (1980) 565.
    """
    for name, x in (("b", b), ("h", h), ("g", g), ("mu", mu)):
        checks.positive(name, x)
    if not 0.0 < theta0 < math.atan2(b, h):
        raise ValueError(f"theta0: expected an angle in (0, {math.atan2(b, h):.6g}), got {theta0!r}")
    s, c = math.sin(theta0), math.cos(theta0)
    return _on_corners(
        b, h, g, mu, [[b * c - h * s - b, b * s + h * c, theta0], [v0, 0.0, 0.0]],
        t_span=(0.0, t_end), name="sliding-rocking-block",
        parameters={"b": b, "h": h, "theta0": theta0, "v0": v0, "mu": mu, "g": g},
    )  # fmt: skip


def _on_corners(b: float, h: float, g: float, mu: float, start: list[Any], **named: Any) -> Scene:
    """A block of 1 kg on its two lower corners."""
    inertia = (b**2 + h**2) / 3.0
    contacts = Contacts(
        2,
        corner_gaps,
        corner_jacobian,
        bias=corner_bias,
        restitution=0.0,
        friction=Coulomb(mu, corner_tangent),
    )
    return Scene(
        system=LinearSystem(M=np.diag([1.0, 1.0, inertia]), force=Harmonic(constant=[0.0, -g, 0.0])),
        contacts=contacts,
        q0=start[0],
        v0=start[1],
        p=[b, h],
        coordinates=["x [m]", "y [m]", "angle [rad]"],
        **named,
    )


def friction_needed(theta0: float, b: float, h: float) -> float:
    """The coefficient of friction from which on the corners of a block let go at theta0 do not slide.

    While it turns about a corner, a = theta'' e + theta'^2 n of the middle gives the ratio of the forces, and the
    velocities before and after an impact that of the impulses. Later, smaller swings ask for less.
    """
    alpha, c, r = math.atan2(b, h), 0.75, impact_ratio(b, h)  # lengths in R = 1, and g = 1
    psi = alpha - theta0 * np.linspace(0.0, 1.0, SWING)  # angle of the diagonal from the vertical
    turn = c * np.sin(psi)
    rate2 = 2.0 * c * (np.cos(alpha - theta0) - np.cos(psi))
    across = turn * np.cos(psi) - rate2 * np.sin(psi)
    up = 1.0 - turn * np.sin(psi) - rate2 * np.cos(psi)
    return max(float(np.max(np.abs(across / up))), h * (1.0 - r) / (b * (1.0 + r)))


def impact_ratio(b: float, h: float) -> float:
    """Rate after an impact over the rate before it."""
    return 1.0 - 1.5 * b * b / (b * b + h * h)


def rocking_times(theta0: float, alpha: float, p: float, r: float, n: int) -> tuple[Array, Array]:
    """Times of the first n impacts [s] and the rates before them [rad/s]."""
    from scipy.special import ellipkinc

    low, high = math.cos(0.5 * alpha), math.sin(0.5 * alpha)
    # cos^2((alpha - theta0)/2) - cos^2(alpha/2), without a difference of near numbers
    first = 2.0 * p * math.sqrt(math.sin(alpha - 0.5 * theta0) * math.sin(0.5 * theta0))
    rates = np.asarray(first * r ** np.arange(n), dtype=float)
    k2 = low**2 + (0.5 * rates / p) ** 2
    amplitude = np.minimum(0.5 * rates / (p * np.sqrt(k2) * high), 1.0)
    halves = ellipkinc(np.arcsin(amplitude), k2) / p
    return np.cumsum(np.where(np.arange(n) == 0, 1.0, 2.0) * halves), rates


def rocking_motion(theta0: float, alpha: float, p: float, r: float) -> Callable[[Array], tuple[Array, Array]]:
    """Signed angle and rate as functions of time, each (m,)."""
    n = FLIGHTS if r == 0.0 else min(FLIGHTS, math.ceil(math.log(SMALLEST) / math.log(r)) + 2)

    def motion(times: Array) -> tuple[Array, Array]:
        from scipy.special import ellipj

        t = np.asarray(times, dtype=float)
        hits, rates = rocking_times(theta0, alpha, p, r, n)
        j = np.searchsorted(hits, t, side="right")
        standing = j >= n
        k = np.sqrt(math.cos(0.5 * alpha) ** 2 + (0.5 * rates[np.minimum(j, n - 1)] / p) ** 2)
        ends = hits[np.minimum(j, n - 1)]
        top = np.where(j == 0, 0.0, 0.5 * (hits[np.maximum(j - 1, 0)] + ends))
        sn, cn, dn, _ = ellipj(p * (t - top), k * k)
        half = np.arccos(np.clip(k * cn / dn, -1.0, 1.0))  # psi/2
        phi = np.maximum(alpha - 2.0 * half, 0.0)
        rate = -2.0 * k * p * (1.0 - k * k) * sn / (dn * dn * np.sin(half))
        sign = np.where(j % 2 == 0, 1.0, -1.0)
        angle: Array = np.where(standing, 0.0, sign * phi)
        speed: Array = np.where(standing, 0.0, sign * rate)
        return angle, speed

    return motion
