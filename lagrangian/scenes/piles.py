"""Blocks at rest: many feet, many blocks, a heavy one on a light one. Nothing may move, and the forces are known.

What usually goes wrong: with more feet than degrees of freedom the Delassus matrix is singular (pivots fail, forces
drift, the block trembles); with a mass ratio R sweeping methods need about 14 R sweeps and direct ones lose log10 R
digits.
"""

from __future__ import annotations

import numpy as np

from lagrangian import checks
from lagrangian.contacts import LinearContacts
from lagrangian.scene import Scene
from lagrangian.scenes.beads import line
from lagrangian.scenes.catalogue import checked
from lagrangian.system import Harmonic, LinearSystem

HEIGHT_AND_ANGLE = (("height", "m"), ("angle", "rad"))


@checked
def block_on_feet(
    n: int = 10, load: float = 0.1, width: float = 1.0, g: float = 9.81, t_end: float = 1.0
) -> Scene:
    """Block of 1 kg at rest on n feet; its weight acts at the distance `load` [m] from the middle.

    The coordinates are the height of the middle and the angle. The feet carry g in sum and g load in moment,
    however they share it.
    """
    if checks.count("n", n) < 2:
        raise ValueError(f"n: expected at least two feet, got {n}")
    checks.positive("width", width)
    if not abs(load) < 0.5 * width:
        raise ValueError(f"load: expected a place above the feet, within {0.5 * width:g} m, got {load!r}")
    feet = width * np.linspace(-0.5, 0.5, n)
    M = [[1.0, load], [load, width**2 / 12.0 + load**2]]
    return Scene(
        system=LinearSystem(M=M, force=Harmonic(constant=[-g, -checks.positive("g", g) * load])),
        contacts=LinearContacts(G=np.stack([np.ones(n), feet], axis=1)),
        q0=[0.0, 0.0],
        v0=[0.0, 0.0],
        t_span=(0.0, t_end),
        parameters={"n": n, "load": load, "width": width, "g": g},
        name="block-on-feet",
        coordinates=["height [m]", "angle [rad]"],
        exact=lambda t: (np.zeros((len(t), 2)), np.zeros((len(t), 2))),
    )


@checked
def stack(n: int = 10, g: float = 9.81, t_end: float = 1.0) -> Scene:
    """Stack of n blocks of 1 kg and unit width at rest, each on two feet; the feet of each carry all above.

    The coordinates are height and angle of every block.
    """
    checks.count("n", n)
    checks.positive("g", g)
    rows = np.zeros((2 * n, 2 * n))
    for k in range(n):
        for side in (0, 1):
            rows[2 * k + side, 2 * k : 2 * k + 2] = 1.0, side - 0.5
            if k > 0:
                rows[2 * k + side, 2 * k - 2 : 2 * k] = -1.0, 0.5 - side
    return Scene(
        system=LinearSystem(
            M=np.diag(np.tile([1.0, 1.0 / 12.0], n)), force=Harmonic(constant=np.tile([-g, 0.0], n))
        ),
        contacts=LinearContacts(G=rows),
        q0=np.zeros(2 * n),
        v0=np.zeros(2 * n),
        t_span=(0.0, t_end),
        parameters={"n": n, "g": g},
        name="stack",
        coordinates=[f"{what} {k + 1} [{unit}]" for k in range(n) for what, unit in HEIGHT_AND_ANGLE],
        exact=lambda t: (np.zeros((len(t), 2 * n)), np.zeros((len(t), 2 * n))),
    )


@checked
def heavy_on_light(ratio: float = 1e9, g: float = 9.81, t_end: float = 1.0) -> Scene:
    """Block of mass `ratio` [kg] at rest on one of 1 kg at rest on the floor."""
    checks.positive("ratio", ratio)
    checks.positive("g", g)
    return line(
        [0.0, 0.0], [0.0, 0.0], [1.0, ratio], 0.0, t_end, "heavy-on-light", {"ratio": ratio, "g": g}, True, g=g,
        exact=lambda t: (np.zeros((len(t), 2)), np.zeros((len(t), 2))),
    )  # fmt: skip
