"""The driven impact oscillator: x'' + 2 zeta x' + x = amplitude cos(omega t), x <= stop.

Source: G. Osorio, Complex Behavior in Impacting Systems, eq. 2.18. Between impacts the motion is known in closed
form. What usually goes wrong: time-stepping is of order one however smooth the motion in between; a mass that rests
against its stop is released late, early, or never.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.scenes.free import Free
from lagrangian.scenes.piecewise import Piecewise
from lagrangian.system import Harmonic, LinearSystem


@checked
def impact_oscillator(
    zeta: float = 0.05,
    omega: float = 2.0,
    amplitude: float = 1.0,
    stop: float = 0.0,
    restitution: float = 0.8,
    q0: float = -0.5,
    v0: float = 0.0,
    t_end: float = 100.0,
) -> Scene:
    """Oscillator of unit mass and stiffness below a stop at x = stop, started at q0, v0."""
    checks.positive("omega", omega)

    def exact(times: Array) -> tuple[Array, Array]:
        y, w = motion()(times)
        return stop - y, -w

    @cache
    def motion() -> Piecewise:  # the gap y = stop - x moves as x does, above y = 0
        free = Free(delta=zeta, kappa=1.0, f0=stop, cosine=-amplitude, omega=omega)
        return Piecewise(free, restitution, (0.0, stop - q0, -v0))

    return Scene(
        system=LinearSystem(
            M=1.0,
            C=2.0 * zeta,
            K=1.0,
            force=Harmonic(cosine=amplitude, omega=omega),
        ),
        contacts=LinearContacts(
            G=-1.0,
            offset=stop,
            restitution=restitution,
        ),
        q0=q0,
        v0=v0,
        t_span=(0.0, t_end),
        parameters={
            "zeta": zeta,
            "omega": omega,
            "amplitude": amplitude,
            "stop": stop,
            "restitution": restitution,
            "q0": q0,
            "v0": v0,
        },
        period=2.0 * math.pi / omega,
        name="impact-oscillator",
        exact=exact,
    )


@checked
def sticking_oscillator(
    zeta: float = 0.05,
    omega: float = 0.25,
    amplitude: float = 2.0,
    stop: float = 0.5,
    restitution: float = 0.6,
    q0: float = -0.5,
    v0: float = 0.0,
    t_end: float = 100.0,
) -> Scene:
    """Oscillator driven slowly: it chatters, rests against its stop, leaves where amplitude cos(omega t) = stop."""
    scene = impact_oscillator(zeta, omega, amplitude, stop, restitution, q0, v0, t_end)
    return replace(scene, name="sticking-oscillator")


@checked
def chaotic_oscillator(
    zeta: float = 0.02,
    omega: float = 2.2,
    amplitude: float = 1.0,
    stop: float = 0.3,
    restitution: float = 0.8,
    q0: float = -0.5,
    v0: float = 0.0,
    t_end: float = 500.0,
) -> Scene:
    """Oscillator whose motion is chaotic: only its statistics and its Lyapunov exponent can be compared."""
    scene = impact_oscillator(zeta, omega, amplitude, stop, restitution, q0, v0, t_end)
    return replace(scene, name="chaotic-oscillator", exact=None)
