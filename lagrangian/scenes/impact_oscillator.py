"""The driven impact oscillator: x'' + 2 zeta x' + x = amplitude cos(omega t), x <= stop.

Source: G. Osorio, Complex Behavior in Impacting Systems, eq. 2.18. Between impacts the motion is known in
closed form. What usually goes wrong: time-stepping is of order one however smooth the motion in between.
"""

from __future__ import annotations

import math

from lagrangian import checks
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.system import Harmonic, LinearSystem


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
    return Scene(
        system=LinearSystem(
            M=1.0,
            C=2.0 * checks.number("zeta", zeta),
            K=1.0,
            force=Harmonic(cosine=checks.number("amplitude", amplitude), omega=omega),
        ),
        contacts=LinearContacts(
            G=-1.0,
            offset=checks.number("stop", stop),
            restitution=checks.number("restitution", restitution, least=0.0, most=1.0),
        ),
        q0=checks.number("q0", q0),
        v0=checks.number("v0", v0),
        t_span=(0.0, checks.positive("t_end", t_end)),
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
    )
