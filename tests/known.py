"""Motions in closed form, each with its source."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import ellipj, ellipk

from lagrangian import Harmonic, LinearSystem, Scene, scenes
from tests.models import pendulum

# An impact falls at another place of its step for every h, and one h scatters: errors are averaged over these.
SPREAD = (1.0, 1.07, 1.13, 1.21, 1.29, 1.37)


@dataclass(frozen=True)
class Known:
    """A scene and its first coordinate as a function of time."""

    name: str
    scene: Scene
    q: Callable[[Any], Any]
    impacts: bool = False


def ball_height(h0: float, g: float, r: float) -> Callable[[Any], Any]:
    """Height of a ball dropped from h0; parabolas of geometrically falling duration [Newton's law of impact]."""

    def q(t: Any) -> Any:
        t, fall = np.asarray(t, dtype=float), math.sqrt(2 * h0 / g)
        # flight n >= 1 begins at fall (1 + 2 (r + ... + r^{n-1})) with speed r^n g fall
        starts = fall * (1 + 2 * np.concatenate([[0.0], np.cumsum(r ** np.arange(1, 400))]))
        n = np.searchsorted(starts, t, side="right")
        tau = t - starts[np.maximum(n - 1, 0)]
        flight = r**n * g * fall * tau - 0.5 * g * tau**2
        return np.where(n == 0, h0 - 0.5 * g * t**2, np.where(t < starts[-1], flight, 0.0))

    return q


def driven(m: float, c: float, k: float, f0: float, fc: float, omega: float, q0: float, v0: float) -> Any:
    """Underdamped oscillator under f0 + fc cos(omega t) [Meirovitch, Fundamentals of Vibrations, ch. 3]."""
    X = fc / (k - m * omega**2 + 1j * c * omega)
    delta, w = c / (2 * m), math.sqrt(k / m - (c / (2 * m)) ** 2)
    A = q0 - f0 / k - X.real
    B = (v0 + delta * A + (X * omega).imag) / w

    def q(t: Any) -> Any:
        t = np.asarray(t, dtype=float)
        return (
            f0 / k
            + (X * np.exp(1j * omega * t)).real
            + np.exp(-delta * t) * (A * np.cos(w * t) + B * np.sin(w * t))
        )

    return q


def two_masses(t: Any) -> Any:
    """First of two unit masses between walls, springs of 1 and 2 (middle), from (1, 0) at rest: modes 1, sqrt 5."""
    return 0.5 * (np.cos(t) + np.cos(math.sqrt(5.0) * np.asarray(t)))


def pendulum_angle(angle: float) -> Callable[[Any], Any]:
    """Pendulum of unit frequency from rest at `angle` [Whittaker, Analytical Dynamics, section 44]."""
    k2 = math.sin(angle / 2) ** 2
    return lambda t: 2 * np.arcsin(math.sqrt(k2) * ellipj(ellipk(k2) - np.asarray(t), k2)[0])


def without_contact(scene: Scene) -> Scene:
    """The same with nothing to meet."""
    return Scene(system=scene.system, q0=scene.q0, v0=scene.v0, t_span=scene.t_span, name=scene.name)


OSCILLATOR = Scene(
    system=LinearSystem(M=2.0, C=0.3, K=5.0, force=Harmonic(constant=1.0, cosine=3.0, omega=1.7)),
    q0=0.5, v0=-1.0, t_span=(0.0, 8.0), name="oscillator",
)  # fmt: skip
MASSES = Scene(
    system=LinearSystem(M=np.eye(2), K=[[3.0, -2.0], [-2.0, 3.0]]),
    q0=[1.0, 0.0], v0=[0.0, 0.0], t_span=(0.0, 6.0), name="masses",
)  # fmt: skip

KNOWN = [
    Known("oscillator", OSCILLATOR, driven(2.0, 0.3, 5.0, 1.0, 3.0, 1.7, 0.5, -1.0)),
    Known("two masses", MASSES, two_masses),
    Known("pendulum", without_contact(pendulum(1.5, 0.5, 6.0)), pendulum_angle(1.5)),
    Known("bouncing ball", scenes.bouncing_ball(t_end=2.5), ball_height(1.0, 9.81, 0.8), impacts=True),
]
