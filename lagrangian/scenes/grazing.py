"""A particle that all but misses its obstacle: free, its gap would be -d + a (t - at)^2/2.

It touches the surface at `at` - sqrt(2 d/a) with the speed sqrt(2 a d). What usually goes wrong: the minimum of the
gap lies inside a step and is never seen; and near it half of the digits are lost, for the speed is the root of a
depth that is itself the difference of two larger numbers.
"""

from __future__ import annotations

import math

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem


@checked
def grazing(
    d: float = 1e-6, a: float = 1.0, at: float = 1.03125, restitution: float = 0.5, t_end: float = 2.0
) -> Scene:
    """Particle pushed off a surface with acceleration a, that would otherwise dip below it by the depth d."""
    checks.positive("d", d)
    checks.positive("a", a)
    checks.positive("at", at)
    q0 = 0.5 * a * at**2 - d
    if not q0 > 0.0:
        raise ValueError(f"d: expected less than a at^2/2 = {0.5 * a * at**2:g} m, got {d!r}")
    hit, up = touch(d, a, at)
    up *= restitution

    def exact(times: Array) -> tuple[Array, Array]:
        t = np.asarray(times, dtype=float)[:, None]
        tau = t - hit
        before, after = (
            (q0 + t * (0.5 * a * t - a * at), a * (t - at)),
            (tau * (up + 0.5 * a * tau), up + a * tau),
        )
        return np.where(tau < 0.0, before[0], after[0]), np.where(tau < 0.0, before[1], after[1])

    return Scene(
        system=LinearSystem(M=1.0, force=Harmonic(constant=a)),
        contacts=LinearContacts(G=1.0, restitution=restitution),
        q0=q0,
        v0=-a * at,
        t_span=(0.0, t_end),
        parameters={"d": d, "a": a, "at": at, "restitution": restitution},
        name="grazing",
        exact=exact,
    )


def touch(d: float, a: float, at: float) -> tuple[float, float]:
    """Time of the touch [s] and its speed [m/s], for the depth that the rounded initial state really has."""
    top = 0.5 * a * at**2
    depth = top - (top - d)
    return at - math.sqrt(2.0 * depth / a), math.sqrt(2.0 * a * depth)
