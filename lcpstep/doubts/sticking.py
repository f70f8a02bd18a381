"""Forces of the user's own that hold a velocity at zero, as dry friction does: -F sign(v).

    f_j(v_j = +d) < 0 < f_j(v_j = -d),        however small d

Steps find the velocity thrown from one side to the other, by less and less time. A contact's Coulomb friction sticks.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.callbacks.prepared import evaluate
from lcpstep.doubts.depth import mass

Array = NDArray[np.float64]
NEAR = 1e-6  # of the velocities, and of a metre a second: zero
HALVINGS = 32
SHARE = 0.5  # of a force that turns about, that is left of it after these


def held(scene: Scene, t: float, q: Array, v: Array, ahead: float = 0.0) -> str:
    """Which velocity a force that jumps holds at zero, now or so much later at most, in words; "" where none does."""
    force = scene.system.force
    if not callable(force):
        return ""
    near = NEAR * (1.0 + float(np.max(np.abs(v))))

    def acceleration(x: Array) -> Array:
        f = evaluate("system.force", force, scene, (t, q, x), v.shape)
        M = mass(scene, t, q, x)
        return np.asarray(np.linalg.solve(M, f), dtype=float) if isinstance(M, np.ndarray) else f

    def turned(j: int, d: float) -> tuple[float, float]:
        below, above = (acceleration(np.where(np.arange(len(v)) == j, x, v))[j] for x in (-d, d))
        return float(below), float(above)

    try:
        for j in np.flatnonzero(np.abs(v) <= near + ahead * np.abs(acceleration(v))):
            (before, after), (below, above) = turned(int(j), near), turned(int(j), near * 0.5**HALVINGS)
            if above < 0.0 < below and below - above > SHARE * (before - after) > 0.0:
                return (
                    f"system.force jumps as v[{j}] goes through zero and holds it there, its acceleration being "
                    f"{below:.6g} before and {above:.6g} after, as dry friction does: give it as a contact's "
                    f"Coulomb friction, or let it turn about smoothly"
                )
    except ValueError:  # a callback that fails beside the motion
        pass
    return ""
