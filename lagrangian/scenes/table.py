"""A ball on a table that moves: q'' = -g, q >= s(t), u+ = -r u- with u = q' - s'(t).

Three tables: one that shakes the ball in a periodic orbit of one impact a period, one that lets it chatter, rest
and fly off again, and one whose velocity jumps. At such a jump (a corner of degree one) the convention of this
library is: u- is taken with the velocity just before the jump, u+ with the new one, as in the limit of a velocity
that changes quickly but smoothly. So a table that is suddenly pushed up takes a ball at rest along, without a
rebound; if it drops, the ball is released; a ball that strikes at the very time of the jump leaves the new velocity
with r times the speed at which it met the old one. What usually goes wrong: the velocity of the table is taken at
the wrong time.
"""

from __future__ import annotations

import math
from functools import partial
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.scenes.free import Free
from lagrangian.scenes.piecewise import Piecewise
from lagrangian.system import Harmonic, LinearSystem


def sine_table(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """s = A sin(omega t + phase); p = (A, omega, phase)."""
    x = p[1] * t + p[2]
    out[0, 0] = p[0] * math.sin(x)
    out[0, 1] = p[0] * p[1] * math.cos(x)
    out[0, 2] = -p[0] * p[1] * p[1] * math.sin(x)


def kinked_table(t: float, q: Any, v: Any, p: Any, out: Any) -> None:
    """s = before (t - at) up to the time `at`, after (t - at) from then on; p = (at, before, after)."""
    speed = p[1] if t < p[0] else p[2]
    out[0, 0], out[0, 1], out[0, 2] = speed * (t - p[0]), speed, 0.0


def orbit_phase(amplitude: float, omega: float, g: float, restitution: float) -> float:
    """Phase of the table at the impact of the orbit with one impact a period; ValueError where there is none."""
    cosine = math.pi * g * (1.0 - restitution) / (amplitude * omega**2 * (1.0 + restitution))
    if not cosine <= 1.0:
        raise ValueError(
            f"amplitude: expected at least {amplitude * cosine:g} m for a periodic orbit, got {amplitude!r}"
        )
    return math.acos(cosine)


def orbit_trace(amplitude: float, omega: float, g: float, restitution: float) -> float:
    """Sum of that orbit's multipliers, whose product is r^2; by linearising flight and impact."""
    sine = math.sin(orbit_phase(amplitude, omega, g, restitution))
    return 1.0 + restitution**2 - (1.0 + restitution) ** 2 * amplitude * omega**2 * sine / g


@checked
def ball_on_table(
    amplitude: float = 0.01,
    omega: float = 35.0,
    restitution: float = 0.5,
    g: float = 9.81,
    t_end: float = 10.0,
) -> Scene:
    """Ball on a table A sin(omega t + phi), started right after the impact of its periodic orbit."""
    _check(amplitude, omega, restitution, g)
    phase = orbit_phase(amplitude, omega, g, restitution)
    period, up = 2.0 * math.pi / omega, math.pi * g / omega
    q0 = amplitude * math.sin(phase)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        tau = (t - period * np.floor(t / period))[:, None]
        return q0 + tau * (up - 0.5 * g * tau), up - g * tau

    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-g)),
        contacts=LinearContacts(G=1.0, restitution=restitution, motion=sine_table),
        q0=q0,
        v0=up,
        t_span=(0.0, t_end),
        p=[amplitude, omega, phase],
        parameters={"amplitude": amplitude, "omega": omega, "restitution": restitution, "g": g},
        period=period,
        name="ball-on-table",
        exact=exact,
    )


@checked
def chattering_table(
    amplitude: float = 0.01,
    omega: float = 40.0,
    restitution: float = 0.3,
    h0: float = 0.02,
    g: float = 9.81,
    t_end: float = 2.0,
) -> Scene:
    """Ball that chatters to rest on a table A sin(omega t) and is thrown off where sin(phase) = g/(A omega^2)."""
    _check(amplitude, omega, restitution, g)
    p = np.array([amplitude, omega, 0.0])
    free = Free(f0=-g)
    motion = Piecewise(
        free,
        restitution,
        (0.0, h0, 0.0),
        partial(_table, sine_table, p=p),
        scan=2.0 * math.pi / omega / 128.0,
    )
    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-g)),
        contacts=LinearContacts(G=1.0, restitution=restitution, motion=sine_table),
        q0=h0,
        v0=0.0,
        t_span=(0.0, t_end),
        p=p,
        parameters={"amplitude": amplitude, "omega": omega, "restitution": restitution, "h0": h0, "g": g},
        period=2.0 * math.pi / omega,
        name="chattering-table",
        exact=motion if h0 > 0.0 else None,
    )


@checked
def jumping_table(
    at: float = 0.3,
    before: float = 0.0,
    after: float = 0.5,
    falling: int = 0,
    restitution: float = 0.5,
    g: float = 9.81,
    t_end: float = 1.0,
) -> Scene:
    """Table whose velocity jumps at a time under a ball at rest, or (falling = 1) one that arrives just then.

    Parameters
    ----------
    at : time of the jump [s]
    before, after : velocity of the table before and after it [m/s]
    """
    checks.positive("at", at)
    checks.positive("g", g)
    if falling not in (0, 1):
        raise ValueError(f"falling: expected 0 or 1, got {falling!r}")
    p = np.array([at, before, after])
    q0, v0 = -before * at, before
    if falling:
        q0, v0 = 0.5 * g * at**2, 0.0
    motion = Piecewise(
        Free(f0=-g), restitution, (0.0, q0, v0), partial(_table, kinked_table, p=p), [at], scan=0.05
    )
    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-g)),
        contacts=LinearContacts(G=1.0, restitution=restitution, motion=kinked_table),
        q0=q0,
        v0=v0,
        t_span=(0.0, t_end),
        p=p,
        parameters={
            "at": at, "before": before, "after": after, "falling": falling,
            "restitution": restitution, "g": g,
        },
        corners=[at],
        name="jumping-table",
        exact=motion,
    )  # fmt: skip


def _check(amplitude: float, omega: float, restitution: float, g: float) -> None:
    checks.positive("amplitude", amplitude)
    checks.positive("omega", omega)
    checks.positive("g", g)


def _table(callback: Any, t: float, *, p: Array) -> tuple[float, float, float]:
    out = np.zeros((1, 3))
    callback(t, p, p, p, out)
    return float(out[0, 0]), float(out[0, 1]), float(out[0, 2])
