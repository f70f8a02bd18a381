"""A ball dropped on a floor: q'' = -g, q >= 0.

It strikes the floor at t_1 with speed v_1 and rises n times with r^n v_1: flight n lasts 2 r^n v_1/g, so that from
rest at h0 it lies still from the accumulation time sqrt(2 h0/g) (1 + r)/(1 - r) on. What usually goes wrong: an
event-driven run stalls at the accumulation of impacts, or the ball tunnels through the floor.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


@checked
def bouncing_ball(
    h0: float = 1.0, v0: float = 0.0, g: float = 9.81, restitution: float = 0.8, t_end: float = 5.0
) -> Scene:
    """Ball of 1 kg falling from height h0 [m] with velocity v0 [m/s] under gravity g [m/s^2]."""
    checks.number("g", g, least=0.0)
    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=-g)),
        contacts=LinearContacts(G=1.0, restitution=restitution),
        q0=h0,
        v0=v0,
        t_span=(0.0, t_end),
        parameters={"h0": h0, "v0": v0, "g": g, "restitution": restitution},
        name="bouncing-ball",
        exact=ball_motion(h0, v0, g, restitution) if g > 0.0 and h0 >= 0.0 else None,
    )


@checked
def dyadic_ball(h0: float = 1.0, g: float = 2.0, restitution: float = 0.5, t_end: float = 4.0) -> Scene:
    """Ball whose impacts at 1, 2, 2.5, 2.75, ... -> 3 fall exactly on the grid of every step 2^-k."""
    return replace(bouncing_ball(h0, 0.0, g, restitution, t_end), name="dyadic-ball")


@checked
def elastic_ball(h0: float = 1.0, g: float = 9.81, bounces: int = 1000, t_end: float | None = None) -> Scene:
    """Ball that loses nothing; it bounces `bounces` times and is back at its start, unless t_end says otherwise."""
    checks.count("bounces", bounces)
    whole = 2.0 * math.sqrt(2.0 * checks.positive("h0", h0) / checks.positive("g", g)) * bounces
    scene = bouncing_ball(h0, 0.0, g, 1.0, whole if t_end is None else t_end)
    return replace(scene, name="elastic-ball", parameters={"h0": h0, "g": g, "bounces": bounces}, p=None)


def impact_times(h0: float, v0: float, g: float, restitution: float, n: int) -> Array:
    """Times of the first n impacts [s]."""
    v1 = math.sqrt(v0 * v0 + 2.0 * g * h0)
    flights = 2.0 * v1 / g * restitution ** np.arange(1, n)
    return (v0 + v1) / g + np.concatenate([[0.0], np.cumsum(flights)])


def rest_time(h0: float, v0: float, g: float, restitution: float) -> float:
    """Time from which on the ball lies still; infinite where it loses nothing."""
    v1 = math.sqrt(v0 * v0 + 2.0 * g * h0)
    if restitution == 1.0:
        return math.inf
    return (v0 + v1) / g + 2.0 * v1 / g * restitution / (1.0 - restitution)


def ball_motion(h0: float, v0: float, g: float, restitution: float) -> Callable[[Array], tuple[Array, Array]]:
    """The motion in closed form, as a function of times not before 0."""
    r, v1 = restitution, math.sqrt(v0 * v0 + 2.0 * g * h0)
    first, rest = (v0 + v1) / g, rest_time(h0, v0, g, restitution)
    unit = 2.0 * v1 / g  # duration of a flight that begins with v1

    def began(n: Array) -> Array:
        """Time between the first impact and the start of flight n >= 1."""
        return unit * ((n - 1.0) if r == 1.0 else r * (1.0 - r ** (n - 1.0)) / (1.0 - r))

    def motion(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        since = np.clip(t - first, 0.0, max(rest - first, 0.0))
        if unit == 0.0 or r == 0.0:
            n = np.ones_like(t)
        elif r == 1.0:
            n = np.floor(since / unit) + 1.0
        else:
            left = np.maximum(1.0 - since * (1.0 - r) / (r * unit), 1e-300)
            n = np.floor(np.log(left) / math.log(r)) + 1.0
        for _ in range(2):  # the rounding of the quotient
            n = np.where(since < began(n), n - 1.0, np.where(since >= began(n + 1.0), n + 1.0, n))
        n = np.maximum(n, 1.0)
        tau = since - began(n)
        up = r**n * v1
        q, v = tau * (up - 0.5 * g * tau), up - g * tau
        falling, still = t < first, t >= rest
        q = np.where(falling, h0 + t * (v0 - 0.5 * g * t), np.where(still, 0.0, np.maximum(q, 0.0)))
        v = np.where(falling, v0 - g * t, np.where(still, 0.0, v))
        return q[:, None], v[:, None]

    return motion
