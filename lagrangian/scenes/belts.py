"""A mass on a spring, pressed on a belt that runs evenly, or to and fro: dry friction that drives.

    x'' + x = -mu sign(x' - b),   |friction| <= mu where x' = b,   b = belt - amplitude omega sin(omega t + phase)

in units of m = k = N = 1. An even belt (amplitude 0) takes the mass along until the spring outweighs the friction. Of
a belt that runs to and fro (belt 0) the motion without a stop is known: between two turns, half a period T = pi/omega
apart, it is an arc of a circle about (-+mu, 0), joined to its own reflection,

    x = mu (1 - cos t - tan(T/2) sin t)  for 0 <= t <= T, backwards,   sin(phase) = mu tan(T/2)/(omega amplitude),

and a turn multiplies deviations of the velocity by the accelerations towards the belt's after and before it. Sources:
J. P. Den Hartog, Forced vibrations with combined Coulomb and viscous friction, Trans. ASME 53 (1931) APM-107; R. I.
Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (Springer 2004), chapter 8. What
usually goes wrong: the sign of the friction flips at every step where the mass is carried along.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.friction import Coulomb
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem

Motion = Callable[[Array], tuple[Array, Array]]
SAMPLES = 2000  # of half a period, at which the sliding velocity must have kept its sign


ALONG = [[1.0, 0.0]]  # the tangent


def backwards(belt: float, amplitude: float, omega: float, phase: float) -> float | Harmonic:
    """Sliding velocity of a mass at rest."""
    if amplitude == 0.0:
        return -belt
    speed = amplitude * omega
    return Harmonic([-belt], [speed * math.sin(phase)], [speed * math.cos(phase)], omega)


@checked
def mass_on_belt(
    belt: float = 0.2,
    mu: float = 0.6,
    amplitude: float = 0.0,
    omega: float = 0.7,
    x0: float = 0.0,
    v0: float = 0.0,
    phase: float = 0.0,
    t_end: float = 40.0,
) -> Scene:
    """Mass of 1 kg on a spring of 1 N/m, pressed on a belt with 1 N.

    An even belt carries it to x = mu, where it slides off for ever, round the circle of radius `belt` that just
    touches the belt's velocity: in closed form from any start. With an amplitude the belt has the period 2 pi/omega.

    Parameters
    ----------
    belt : mean velocity of the belt [m/s]
    amplitude, omega, phase : of its swaying amplitude cos(omega t + phase) about that [m], [rad/s], [rad]
    """
    for name, value in (("mu", mu), ("omega", omega)):
        checks.positive(name, value)
    checks.number("belt", belt, least=0.0)
    checks.number("amplitude", amplitude, least=0.0)
    even = amplitude == 0.0 and belt > 0.0
    exact = even_belt(x0, v0, belt, mu, mu) if even else None
    parameters = {
        "belt": belt, "mu": mu, "amplitude": amplitude, "omega": omega, "x0": x0, "v0": v0, "phase": phase
    }  # fmt: skip
    p = [belt, amplitude, omega, phase]
    return _scene("mass-on-belt", parameters, p, coulomb(mu, p), (x0, v0), t_end, exact)


def falling(t: float, q: Any, u: Any, p: Any, out: Any) -> None:
    """Stribeck's coefficient of the sliding velocity u: p[5] at rest, falling to p[4] over p[6] m/s."""
    out[0] = p[4] + (p[5] - p[4]) * math.exp(-abs(u[0]) / p[6])


@checked
def stick_slip_belt(
    belt: float = 0.2,
    mu: float = 0.6,
    mu_s: float = 1.0,
    decay: float = 0.0,
    amplitude: float = 0.0,
    omega: float = 0.7,
    x0: float = 0.0,
    t_end: float = 40.0,
) -> Scene:
    """Mass of 1 kg on a spring of 1 N/m that a belt takes along, pressed on it with 1 N: it sticks and slips.

    Static friction is above the kinetic one: carried to x = mu_s, it slips round to 2 mu - mu_s. With a = mu_s - mu
    the period is 2 a/belt + pi + 2 atan(belt/a) if the belt runs evenly. With a `decay` [m/s] the coefficient falls
    from mu_s to mu with the sliding velocity, as mu + (mu_s - mu) exp(-|u|/decay) (Stribeck), and the slip is one
    equation of second order. The belt may sway as that of `mass_on_belt`.
    """
    for name, value in (("mu", mu), ("omega", omega), ("belt", belt)):
        checks.positive(name, value)
    checks.number("mu_s", mu_s, least=mu)
    checks.number("decay", decay, least=0.0)
    checks.number("amplitude", amplitude, least=0.0)
    checks.number("x0", x0, least=-mu_s, most=mu_s)
    known = decay == 0.0 and amplitude == 0.0
    exact = even_belt(x0, belt, belt, mu_s, mu) if known else None
    parameters = {
        "belt": belt, "mu": mu, "mu_s": mu_s, "decay": decay, "amplitude": amplitude, "omega": omega, "x0": x0
    }  # fmt: skip
    p = [belt, amplitude, omega, 0.0, mu, mu_s, decay]
    friction = Coulomb(falling if decay > 0.0 else mu, ALONG, slip=backwards(*p[:4]), mu_s=mu_s)
    return _scene("stick-slip-belt", parameters, p, friction, (x0, belt), t_end, exact)


def stick_slip_period(belt: float, mu: float, mu_s: float) -> float:
    """Period of the motion on an even belt [s]."""
    a = mu_s - mu
    return 2.0 * a / belt + math.pi + 2.0 * math.atan2(belt, a)


@checked
def mass_on_shaken_belt(
    mu: float = 0.1, amplitude: float = 1.0, omega: float = 1.5, t_end: float = 40.0
) -> Scene:
    """Mass of 1 kg on a spring of 1 N/m, on a belt that runs to and fro; started on its motion without a stop.

    The belt is at amplitude cos(omega t + phase). The motion exists where friction is weak (ValueError elsewhere),
    repeats after 2 pi/omega, and has `shaken_multipliers` in closed form.
    """
    for name, value in (("mu", mu), ("omega", omega), ("amplitude", amplitude)):
        checks.positive(name, value)
    half, (x, v, _) = math.pi / omega, shaken_arc(mu, omega)
    phase = shaken_phase(mu, amplitude, omega)

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)
        turns = np.floor(t / half)
        side, tau = np.where(turns % 2 == 0, 1.0, -1.0), t - turns * half
        return _with_height(side * x(tau), side * v(tau))

    parameters = {"mu": mu, "amplitude": amplitude, "omega": omega}
    start = float(x(np.zeros(1))[0]), float(v(np.zeros(1))[0])
    p = [0.0, amplitude, omega, phase]
    return _scene("mass-on-shaken-belt", parameters, p, coulomb(mu, p), start, t_end, exact)


def shaken_arc(mu: float, omega: float) -> tuple[Callable[[Array], Array], ...]:
    """Position, velocity and acceleration within the half period in which the mass slides backwards."""
    slope = mu * math.tan(0.5 * math.pi / omega)
    return (
        lambda t: mu - mu * np.cos(t) - slope * np.sin(t),
        lambda t: mu * np.sin(t) - slope * np.cos(t),
        lambda t: mu * np.cos(t) + slope * np.sin(t),
    )


def shaken_phase(mu: float, amplitude: float, omega: float) -> float:
    """Phase of the belt at a turn; ValueError where there is no motion without a stop."""
    half, (_, v, _) = math.pi / omega, shaken_arc(mu, omega)
    sine = mu * math.tan(0.5 * half) / (omega * amplitude)
    for phase in (math.pi - math.asin(sine), math.asin(sine)) if abs(sine) < 1.0 else ():
        t = half * (np.arange(SAMPLES) + 0.5) / SAMPLES
        if np.all(v(t) + omega * amplitude * np.sin(omega * t + phase) < 0.0):
            return phase
    raise ValueError(f"mu: expected friction weak enough for a motion without a stop, got {mu!r}")


def shaken_multipliers(mu: float, amplitude: float, omega: float) -> tuple[complex, complex]:
    """Multipliers of the motion without a stop over a whole period: squares of those of half a period.

    Deviations turn by half a period of the free motion, and are reflected; their velocity is multiplied where the
    sliding turns about.
    """
    half, (_, _, a) = math.pi / omega, shaken_arc(mu, omega)
    phase = shaken_phase(mu, amplitude, omega)
    belt = -amplitude * omega**2 * math.cos(phase)  # its acceleration at a turn to backwards
    after = float(a(np.zeros(1))[0]) - belt
    before = -float(a(np.array([half]))[0]) - belt
    c, s = math.cos(half), math.sin(half)
    J = -np.array([[c, s], [-s * after / before, c * after / before]])
    first, second = np.linalg.eigvals(J @ J).astype(complex)
    return complex(first), complex(second)


def stick_slip(times: Array, belt: float, static: float, kinetic: float, x0: float) -> tuple[Array, Array]:
    """Position and velocity of a mass that an even belt carries from x0 on, to the first slip and round and round.

    It slips along an arc of a circle about (kinetic, 0), and is carried again from 2 kinetic - static on.
    """
    a = static - kinetic
    theta = math.atan2(belt, a)
    slip, period = math.pi + 2.0 * theta, math.pi + 2.0 * theta + 2.0 * a / belt
    since = np.asarray(times, dtype=float) - (static - x0) / belt  # the first slip
    tau = np.where(since < 0.0, since, since % period)
    slipping = (tau >= 0.0) & (tau < slip)
    angle, radius = tau - theta, math.hypot(a, belt)
    carried = np.where(tau < 0.0, static + belt * tau, 2.0 * kinetic - static + belt * (tau - slip))
    x = np.where(slipping, kinetic + radius * np.cos(angle), carried)
    return x, np.where(slipping, -radius * np.sin(angle), belt)


def even_belt(x: float, v: float, belt: float, static: float, kinetic: float) -> Motion:
    """The motion from any start on an even belt: arcs of circles, then `stick_slip`, if it comes to that."""
    arcs: list[
        tuple[float, float, float, float]
    ] = []  # start, centre, radius, angle: x = centre + radius cos(..)
    t, carried = 0.0, v == belt and abs(x) <= static
    while not carried:
        slower = v < belt or (v == belt and x > 0.0)
        centre = kinetic if slower else -kinetic
        radius, angle = math.hypot(x - centre, v), math.atan2(-v, x - centre)
        arcs.append((t, centre, radius, angle))
        if slower and radius <= belt:
            break  # round and round, and never as fast as the belt
        rise = math.asin(belt / radius)
        meet = math.pi + rise if slower else -rise
        t += (meet - angle) % (2.0 * math.pi)
        x, v = centre + radius * math.cos(meet), belt
        carried = abs(x) <= static

    def motion(times: Array) -> tuple[Array, Array]:
        s = np.asarray(times, dtype=float)
        q, w = stick_slip(s - t, belt, static, kinetic, x) if carried else (0.0 * s, 0.0 * s)
        for start, centre, radius, angle in arcs:
            on = (s >= start) & ((s < t) if carried else True)
            q = np.where(on, centre + radius * np.cos(s - start + angle), q)
            w = np.where(on, -radius * np.sin(s - start + angle), w)
        return _with_height(q, w)

    return motion


def coulomb(mu: float, belt: list[float]) -> Coulomb:
    """Friction with one coefficient, against the belt; see `backwards`."""
    return Coulomb(mu, ALONG, slip=backwards(*belt))


def _with_height(x: Array, v: Array) -> tuple[Array, Array]:
    return np.stack([x, 0.0 * x], axis=1), np.stack([v, 0.0 * v], axis=1)


def _scene(
    name: str,
    parameters: dict[str, float],
    p: list[float],
    friction: Coulomb,
    start: tuple[float, float],
    t_end: float,
    exact: Motion | None,
) -> Scene:
    amplitude, omega = p[1:3]
    return Scene(
        system=LinearSystem(M=np.eye(2), K=np.diag([1.0, 0.0]), force=Harmonic(constant=[0.0, -1.0])),
        contacts=LinearContacts(G=[[0.0, 1.0]], restitution=0.0, friction=friction),
        q0=[start[0], 0.0],
        v0=[start[1], 0.0],
        t_span=(0.0, t_end),
        p=p,
        parameters=parameters,
        period=2.0 * math.pi / omega if amplitude > 0.0 else math.inf,
        name=name,
        exact=exact,
        coordinates=["x [m]", "height [m]"],
    )
