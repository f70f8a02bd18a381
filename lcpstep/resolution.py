"""Whether the steps of a finished run are short enough for the forces that it has met.

    (h omega)^2 = h^2 |v^T (a(q + e v) - a(q - e v))| / (2 e v^T v) <= 4,      in the metric of M,   a = M^-1 f

The quotient of Rayleigh along the motion is never above the highest frequency there, so what exceeds the bound of
velocity Verlet (of Runge-Kutta's steps 2.8^2) exceeds it for certain: explicit steps gain energy then, and implicit
ones skip what the motion does. Steps by a tolerance are not asked, nor those that take linear forces implicitly.
Source: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section I.5.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearSystem, Scene, checks
from lcpstep.trajectory import Status, Trajectory

Array = NDArray[np.float64]
LOOKS = 8  # states that are looked at
NEAR = 1.0 / 64.0  # of a step: of the differences
VERLET, RUNGE_KUTTA = 2.0, 2.8  # highest frequency times h


def unresolved(run: Trajectory) -> str:
    """Where a step is too long for the forces, in words; "" where none is that was looked at."""
    h, bound = _explicit(run)
    if h == 0.0 or run.status != Status.DONE or len(run.t) == 0:
        return ""
    last = len(run.t) - 1
    try:
        with np.errstate(all="ignore"):
            for k in sorted({int((i + 1) * (last / LOOKS)) for i in range(LOOKS)}):
                angle = h * np.sqrt(_rate(run.scene, float(run.t[k]), run.q[k], run.v[k], NEAR * h))
                if angle > bound:
                    return (
                        f"the forces along the motion change too fast for its steps at t = {run.t[k]:.9g} s, "
                        f"with the frequency {angle / h:.3g} rad/s, which needs steps below {bound / angle * h:.3g} s"
                    )
    except ValueError:  # a callback that fails beside the motion, where the run has not asked it
        pass
    return ""


def _explicit(run: Trajectory) -> tuple[float, float]:
    """The step h, or 0 where forces cannot change too fast for the method, and the bound of h omega."""
    method, scene = run.method, run.scene
    order = getattr(method, "order", None)
    if getattr(method, "tolerance", None) is not None or order == "exact":
        return 0.0, VERLET
    if isinstance(scene.system, LinearSystem):
        rubs = scene.contacts is not None and scene.contacts.friction is not None
        if order is None or (order == 2 and not rubs and scene.n_j == 0):
            return 0.0, VERLET
    return getattr(method, "h", 0.0), RUNGE_KUTTA if order == 4 else VERLET


def _rate(scene: Scene, t: float, q: Array, v: Array, near: float) -> float:
    """omega^2 along the motion."""
    system, p = scene.system, np.array(scene.p)
    M: Any = system.M if isinstance(system, LinearSystem) else system.mass
    at = (t, q, v, p)
    here = checks.evaluate("system.mass", M, at, 2 * q.shape) if callable(M) else M
    size = float(v @ (here @ v))
    if not size > 0.0:
        return 0.0
    if isinstance(system, LinearSystem):
        K: Any = system.K
        return abs(float(v @ (K @ v))) / size
    a = []
    for x in (q + near * v, q - near * v):
        there = checks.evaluate("system.mass", M, (t, x, v, p), 2 * q.shape) if callable(M) else M
        a.append(np.linalg.solve(there, checks.evaluate("system.force", system.force, (t, x, v, p), q.shape)))
    return abs(float(v @ (here @ (a[0] - a[1])))) / (2.0 * near * size)
