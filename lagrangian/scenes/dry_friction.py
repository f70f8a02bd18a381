"""Dry friction with motions in closed form: oscillator, wheel, block on the flat, block that lands on a slope.

    |lambda_T| <= mu lambda_N,   lambda_T = -mu lambda_N sign(u_T) where it slides

Each is pressed on its floor y = 0 by a weight. Source of the motions: any text on mechanics, e.g. J. P. Den Hartog,
Mechanical Vibrations, section 8.7 (oscillator). What usually goes wrong: bodies creep, or their sliding velocity
changes its sign for ever; the friction impulse is forgotten at an impact.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


@checked
def coulomb_oscillator(x0: float = 1.05, drag: float = 0.1, t_end: float = 20.0) -> Scene:
    """Oscillator x'' + x = -drag sign(x') let go at x0: each half cycle loses 2 drag, until it stops.

    The coordinates are x and the height above the floor, on which it is pressed with 1 N.
    """
    checks.positive("drag", drag)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        half = np.minimum(np.floor(t / math.pi), half_cycles(x0, drag))
        size, side = np.abs(x0) - 2.0 * drag * half, np.where(half % 2 == 0, 1.0, -1.0) * np.sign(x0)
        moving = half < half_cycles(x0, drag)
        tau = t - half * math.pi
        x = np.where(moving, side * (drag + (size - drag) * np.cos(tau)), side * size)
        v = np.where(moving, -side * (size - drag) * np.sin(tau), 0.0)
        return np.stack([x, 0.0 * x], axis=1), np.stack([v, 0.0 * v], axis=1)

    return _on_floor(
        "coulomb-oscillator",
        {"x0": x0, "drag": drag},
        LinearSystem(M=np.eye(2), K=np.diag([1.0, 0.0]), force=Harmonic(constant=[0.0, -1.0])),
        Coulomb(drag, [[1.0, 0.0]]),
        [x0, 0.0],
        [0.0, 0.0],
        t_end,
        exact,
    )


def half_cycles(x0: float, drag: float) -> int:
    """Half cycles until the oscillator stops, at |x| <= drag."""
    return max(0, math.ceil((abs(x0) - drag) / (2.0 * drag) - 1e-12))


@checked
def slipping_wheel(
    v0: float = 1.0,
    mu: float = 0.2,
    beta: float = 0.5,
    radius: float = 0.3,
    g: float = 9.81,
    t_end: float = 1.0,
) -> Scene:
    """Wheel of 1 kg thrown along a floor with v0 [m/s] without spin: it slips, and rolls from `slip_time` on.

    The coordinates are x, height, and angle (counted so that the rim slides with x' + R angle').

    Parameters
    ----------
    beta : moment of inertia over m R^2: 1/2 for a disc, 1 for a hoop
    """
    for name, x in (("mu", mu), ("beta", beta), ("radius", radius), ("g", g), ("v0", v0)):
        checks.positive(name, x)
    end = slip_time(v0, mu, beta, g)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        slipping, after = np.minimum(t, end), np.maximum(t - end, 0.0)
        x = slipping * (v0 - 0.5 * mu * g * slipping) + after * (v0 - mu * g * end)
        angle = -mu * g / (beta * radius) * (0.5 * slipping**2 + after * end)
        v, spin = v0 - mu * g * slipping, -mu * g / (beta * radius) * slipping
        return np.stack([x, 0.0 * x, angle], axis=1), np.stack([v, 0.0 * v, spin], axis=1)

    return _on_floor(
        "slipping-wheel",
        {"v0": v0, "mu": mu, "beta": beta, "radius": radius, "g": g},
        LinearSystem(M=np.diag([1.0, 1.0, beta * radius**2]), force=Harmonic(constant=[0.0, -g, 0.0])),
        Coulomb(mu, [[1.0, 0.0, radius]]),
        [0.0, 0.0, 0.0],
        [v0, 0.0, 0.0],
        t_end,
        exact,
    )


def slip_time(v0: float, mu: float, beta: float, g: float) -> float:
    """Time at which the wheel begins to roll [s]."""
    return v0 / (mu * g * (1.0 + 1.0 / beta))


@checked
def sliding_block(v0: float = 1.0, mu: float = 0.3, g: float = 9.81, t_end: float = 1.0) -> Scene:
    """Block of 1 kg sliding along a floor; it stops at v0/(mu g) after the distance v0^2/(2 mu g)."""
    return _slope("sliding-block", {"v0": v0, "mu": mu, "g": g}, 0.0, 0.0, v0, mu, g, t_end)


@checked
def slope_landing(
    slope: float = 0.3,
    height: float = 0.2,
    v0: float = 3.0,
    mu: float = 0.5,
    g: float = 9.81,
    t_end: float = 2.0,
) -> Scene:
    """Block of 1 kg that falls on a slope [rad] and does not rebound; friction acts in the impact too.

    The coordinates are those along the slope, downwards, and normal to it. The block arrives with v_N and v_T; it
    sticks iff |v_T| <= mu |v_N|, and loses mu |v_N| otherwise.
    """
    if not 0.0 <= slope < 0.5 * math.pi:
        raise ValueError(f"slope: expected an angle in [0, pi/2), got {slope!r}")
    if height < 0.0:
        raise ValueError(f"height: expected a number >= 0, got {height!r}")
    parameters = {"slope": slope, "height": height, "v0": v0, "mu": mu, "g": g}
    return _slope("slope-landing", parameters, slope, height, v0, mu, g, t_end)


def _slope(
    name: str,
    parameters: dict[str, float],
    slope: float,
    height: float,
    v0: float,
    mu: float,
    g: float,
    t_end: float,
) -> Scene:
    checks.positive("mu", mu)
    checks.positive("g", g)
    if v0 < 0.0:
        raise ValueError(f"v0: expected a velocity down the slope, v0 >= 0, got {v0!r}")
    along, down = g * math.sin(slope), g * math.cos(slope)
    landing = math.sqrt(2.0 * height / down)
    arriving = v0 + along * landing
    left = max(arriving - mu * down * landing, 0.0)
    gain = along - mu * down  # acceleration of a block that slides down
    if left == 0.0 and gain <= 0.0:
        stop = landing
    else:
        stop = landing + left / -gain if gain < 0.0 else math.inf
    x_landing = landing * (v0 + 0.5 * along * landing)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        flying, tau = t < landing, np.clip(t - landing, 0.0, stop - landing)
        x = np.where(flying, t * (v0 + 0.5 * along * t), x_landing + tau * (left + 0.5 * gain * tau))
        y = np.where(flying, height - 0.5 * down * t * t, 0.0)
        v = np.where(flying, v0 + along * t, np.where(t < stop, left + gain * tau, 0.0))
        return np.stack([x, y], axis=1), np.stack([v, np.where(flying, -down * t, 0.0)], axis=1)

    return _on_floor(
        name,
        parameters,
        LinearSystem(M=np.eye(2), force=Harmonic(constant=[along, -down])),
        Coulomb(mu, [[1.0, 0.0]]),
        [0.0, height],
        [v0, 0.0],
        t_end,
        exact,
    )


def _on_floor(
    name: str,
    parameters: dict[str, float],
    system: LinearSystem,
    friction: Coulomb,
    q0: list[float],
    v0: list[float],
    t_end: float,
    exact: Callable[[Array], tuple[Array, Array]],
) -> Scene:
    normal = np.zeros((1, len(q0)))
    normal[0, 1] = 1.0
    return Scene(
        system=system,
        contacts=LinearContacts(G=normal, restitution=0.0, friction=friction),
        q0=q0,
        v0=v0,
        t_span=(0.0, t_end),
        parameters=parameters,
        name=name,
        exact=exact,
        coordinates=["x [m]", "height [m]", "angle [rad]"][: len(q0)],
    )
