"""Oscillators with modes: bilinear, dry friction as a Filippov system, stick-slip on a belt; with closed forms.

States are x = (position, velocity); units are those of m = k = 1. Sources: G. Osorio, Complex Behavior in Impacting
Systems, sections 2.13 and 2.14; R. I. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems
(Springer 2004), chapter 8.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.hybrid import HybridScene, HybridSystem
from lagrangian.modes import FALLING, Guard, Mode, Surface
from lagrangian.scenes.belts import stick_slip
from lagrangian.scenes.catalogue import checked
from lagrangian.scenes.dry_friction import coulomb_oscillator

LABELS = ("position [-]", "velocity [-]")  # in the units of m = k = 1
ON_THE_BELT = 1e-9  # difference of velocities that is none, relative to the belt's own


def _position(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[0]


def _velocity(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[1]


def _bilinear_left(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], p[3] * math.cos(p[4] * t) - p[0] * x[0] - p[2] * x[1]


def _bilinear_right(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], p[3] * math.cos(p[4] * t) - p[1] * x[0] - p[2] * x[1]


def _bilinear_side(t: float, x: Any, p: Any) -> str:
    return "right" if x[0] > 0.0 or (x[0] == 0.0 and x[1] > 0.0) else "left"


@checked
def bilinear_oscillator(
    left: float = 1.0,
    right: float = 9.0,
    damping: float = 0.0,
    amplitude: float = 0.0,
    omega: float = 1.0,
    x0: float = -1.0,
    v0: float = 0.0,
    t_end: float = 20.0,
) -> HybridScene:
    """Oscillator whose stiffness is another on either side of x = 0: x'' + c x' + k(x) x = F cos(omega t).

    Free and undamped it has the period pi/sqrt(left) + pi/sqrt(right), and its motion in closed form.
    """
    for name, value in (("left", left), ("right", right), ("omega", omega), ("t_end", t_end)):
        checks.positive(name, value)
    system = HybridSystem(
        2,
        {
            "left": Mode(_bilinear_left, [Guard(_position, "right")]),
            "right": Mode(_bilinear_right, [Guard(_position, "left", FALLING)]),
        },
        mode_of=_bilinear_side,
    )
    free = damping == 0.0 and amplitude == 0.0
    return HybridScene(
        system,
        [x0, v0],
        _bilinear_side(0.0, (x0, v0), ()),
        (0.0, t_end),
        parameters={"left": left, "right": right, "damping": damping, "amplitude": amplitude, "omega": omega},
        period=math.inf if amplitude == 0.0 else 2.0 * math.pi / omega,
        name="bilinear-oscillator",
        exact=partial(_two_half_waves, left=left, right=right, x0=x0, v0=v0) if free else None,
        labels=LABELS,
    )


@checked
def driven_bilinear_oscillator(
    left: float = 1.0,
    right: float = 16.0,
    damping: float = 0.2,
    amplitude: float = 1.0,
    omega: float = 2.3,
    x0: float = 0.0,
    v0: float = 0.0,
    t_end: float = 60.0,
) -> HybridScene:
    """Oscillator whose stiffness is another on either side of x = 0, driven: x'' + c x' + k(x) x = F cos(omega t).

    The period is that of the drive, F = 0 included. As given, two orbits are stable, O(1, 2) and O(3, 6).
    """
    scene = bilinear_oscillator(left, right, damping, amplitude, omega, x0, v0, t_end)
    return replace(scene, name="driven-bilinear-oscillator", period=2.0 * math.pi / omega)


def _two_half_waves(times: Array, left: float, right: float, x0: float, v0: float) -> Array:
    """Half waves of sines on either side, joined at x = 0 with the speed w."""
    a, b = math.sqrt(left), math.sqrt(right)
    w = math.hypot(v0, (a if x0 < 0.0 else b) * x0)
    # The phase counts from a passage to the right: [0, pi/b) on the right, then [pi/b, pi/a + pi/b) on the left.
    start = math.atan2(b * x0, v0) / b if x0 >= 0.0 else math.pi / b + math.atan2(-a * x0, -v0) / a
    tau = (np.asarray(times, dtype=float) + start) % (math.pi / a + math.pi / b)
    on_right = tau < math.pi / b
    s, c = np.where(on_right, b * tau, a * (tau - math.pi / b)), np.where(on_right, 1.0, -1.0)
    return np.stack([c * w * np.sin(s) / np.where(on_right, b, a), c * w * np.cos(s)], axis=1)


def _drag_left(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], p[1] * math.sin(p[2] * t) - x[0] + p[0]


def _drag_right(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], p[1] * math.sin(p[2] * t) - x[0] - p[0]


@checked
def dry_friction_oscillator(
    x0: float = 1.05, drag: float = 0.1, amplitude: float = 0.0, omega: float = 1.0, t_end: float = 20.0
) -> HybridScene:
    """Oscillator with dry friction, from rest: x'' + x = -drag sign(x') + F sin(omega t), a Filippov system.

    The surface is x' = 0; the sliding mode "stick" rests while |F sin(omega t) - x| <= drag. Without forcing the
    motion is that of `coulomb_oscillator`, in closed form; a forced one starts where F sin(omega t) = x0 +- drag.
    """
    for name, value in (("drag", drag), ("omega", omega), ("t_end", t_end)):
        checks.positive(name, value)
    checks.number("x0", x0)
    system = HybridSystem(
        2,
        {"left": Mode(_drag_left), "right": Mode(_drag_right)},
        [Surface(_velocity, "left", "right", "stick")],
    )
    start = "left" if x0 > drag else "right" if x0 < -drag else "stick"
    return HybridScene(
        system,
        [x0, 0.0],
        start,
        (0.0, t_end),
        parameters={"drag": drag, "amplitude": amplitude, "omega": omega},
        period=math.inf if amplitude == 0.0 else 2.0 * math.pi / omega,
        name="dry-friction-oscillator",
        exact=partial(_joined, motion=coulomb_oscillator(x0, drag).exact) if amplitude == 0.0 else None,
        labels=LABELS,
    )


def _joined(times: Array, motion: Any) -> Array:
    """A motion in closed form as states (x, x') of the first coordinate."""
    q, v = motion(times)
    return np.stack([q[:, 0], v[:, 0]], axis=1)


def _pull(t: float, x: Any, p: Any) -> float:
    """Spring less drive: what the friction holds while the block sticks."""
    return x[0] - p[3] * math.cos(p[4] * t)


def _slower(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], p[2] - _pull(t, x, p)


def _faster(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[1], -p[2] - _pull(t, x, p)


def _carried(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = p[0], 0.0


def _over_belt(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[1] - p[0]


def _pulled(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = _pull(t, x, p) - p[1]


def _pushed(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = _pull(t, x, p) + p[1]


def _on_belt(t: float, x: Any, p: Any, out: Any) -> None:
    out[0], out[1] = x[0], p[0]


def _against_belt(t: float, x: Any, p: Any) -> str:
    over, pull = x[1] - p[0], _pull(t, x, p)
    if abs(over) > ON_THE_BELT * max(1.0, abs(p[0])):
        return "slower" if over < 0.0 else "faster"
    return "stick" if abs(pull) <= p[1] else "slower" if pull > 0.0 else "faster"


@checked
def stick_slip_oscillator(
    belt: float = 0.2,
    static: float = 1.0,
    kinetic: float = 0.6,
    x0: float = 0.0,
    t_end: float = 40.0,
    amplitude: float = 0.0,
    omega: float = 1.0,
) -> HybridScene:
    """Block on a belt that runs with `belt`, held by a spring; static friction above the kinetic one.

    Carried by the belt from x0 on, it slips where the spring outweighs the static friction and sticks again at
    x = 2 kinetic - static. With a = static - kinetic the period is 2 a/belt + pi + 2 atan(belt/a). A drive
    F cos(omega t) pulls at the block; with F = 0 there is none, and no period of it.
    """
    for name, value in (("belt", belt), ("kinetic", kinetic), ("omega", omega), ("t_end", t_end)):
        checks.positive(name, value)
    checks.number("static", static, least=kinetic)
    checks.number("x0", x0, least=-static, most=static)
    system = HybridSystem(
        2,
        {
            "stick": Mode(_carried, [Guard(_pulled, "slower"), Guard(_pushed, "faster", FALLING)]),
            "slower": Mode(_slower, [Guard(_over_belt, "stick", reset=_on_belt)]),
            "faster": Mode(_faster, [Guard(_over_belt, "stick", FALLING, reset=_on_belt)]),
        },
        mode_of=_against_belt,
    )
    numbers = {"belt": belt, "static": static, "kinetic": kinetic, "amplitude": amplitude, "omega": omega}
    free = amplitude == 0.0
    return HybridScene(
        system,
        [x0, belt],
        _against_belt(0.0, (x0, belt), list(numbers.values())),
        (0.0, t_end),
        parameters=numbers,
        period=math.inf if free else 2.0 * math.pi / omega,
        name="stick-slip-oscillator",
        exact=partial(_stick_slip, belt=belt, static=static, kinetic=kinetic, x0=x0) if free else None,
        labels=LABELS,
    )


def _stick_slip(times: Array, belt: float, static: float, kinetic: float, x0: float) -> Array:
    """`stick_slip` as states (x, x')."""
    return np.stack(stick_slip(times, belt, static, kinetic, x0), axis=1)
