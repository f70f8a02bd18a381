"""Two methods on one scene: how far apart their motions are, and what each cost.

    sup |q - q_ref|,   L1 norms  int |q - q_ref| dt,  int |v - v_ref| dt,   first impact times

The reference is evaluated at the times of the other run. A velocity that jumps is compared in L1: its pointwise
sup does not converge across a jump. Source of the quantities: V. Acary, B. Brogliato, Numerical Methods for
Nonsmooth Dynamical Systems (Springer 2008), section 9.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.simulation import Method, fitted, simulate
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
FIRST_IMPACTS = 3


@dataclass(frozen=True, eq=False)
class Timed:
    """A trajectory and the time it took."""

    trajectory: Trajectory
    seconds: float  # wall time, compilation left out

    @property
    def impacts(self) -> Array:
        """Times of the impacts [s]."""
        log = self.trajectory.impacts
        return np.asarray(log.time[log.kind == Kind.IMPACT], dtype=float)


@dataclass(frozen=True, eq=False)
class Comparison:
    """Difference of two runs of one scene.

    Attributes
    ----------
    fast, reference : Timed
    difference : (n, n_q)   q - q_ref at the times of the fast run [m]
    sup_q : sup norm of the difference [m]
    l1_q, l1_v : integrals of |q - q_ref| [m s] and |v - v_ref| [m] over the span, largest coordinate
    first_impacts : (k,)   differences of the first impact times, one by one [s]
    """

    fast: Timed
    reference: Timed
    difference: Array
    sup_q: float
    l1_q: float
    l1_v: float
    first_impacts: Array


def compare(
    scene: Scene, method: Method, reference: Method, progress: Callable[[float], None] | None = None
) -> Comparison:
    """Run both methods on the scene and measure how far apart they are.

    Parameters
    ----------
    scene : lagrangian.Scene
    method, reference : for example lcpstep.Moreau(h=1e-4) and lcpstep.EventDriven()
    progress : called now and then with the time reached [s], by both runs

    Raises
    ------
    Everything that `lcpstep.simulate` raises.
    """
    checks.instance("scene", scene, Scene)
    exact = timed(scene, reference, progress)
    fast = timed(scene, method, progress)
    t = fast.trajectory.t
    both = t <= exact.trajectory.t[-1]
    q, v = exact.trajectory.at(t[both])
    dq, dv = fast.trajectory.q[both] - q, fast.trajectory.v[both] - v
    k = min(FIRST_IMPACTS, len(fast.impacts), len(exact.impacts))
    return Comparison(
        fast=fast,
        reference=exact,
        difference=dq,
        sup_q=float(np.max(np.abs(dq))),
        l1_q=_l1(t[both], dq),
        l1_v=_l1(t[both], dv),
        first_impacts=fast.impacts[:k] - exact.impacts[:k],
    )


def timed(scene: Scene, method: Method, progress: Callable[[float], None] | None = None) -> Timed:
    """A run and its wall time; one short run before it takes the compilation."""
    t_start, t_end = scene.t_span
    short = replace(scene, t_span=(t_start, t_start + 1e-6 * (t_end - t_start)))
    simulate(short, fitted(method, short.t_span))
    start = time.perf_counter()
    trajectory = simulate(scene, method, progress=progress)
    return Timed(trajectory, time.perf_counter() - start)


def _l1(t: Array, x: Array) -> float:
    """Integral of |x| over t, of the coordinate where it is largest; trapezoidal rule."""
    return float(np.max(np.trapezoid(np.abs(x), t, axis=0)))
