"""How far steps of order two may have led the motion away since the start or the last event: an estimate.

Over a step h with the accelerations a, whose differences from step to step are da and dda, the trapezoidal rule and
velocity Verlet err by at most about

    h^2 |da| / 6   in position,      h |dda| / 12   in velocity

(E. Hairer, G. Wanner, C. Lubich, Geometric numerical integration, section I.1). These are added up. An error of the
velocity moves the position by as much times the time that has passed, or, where the motion is held by a spring, by
1 / omega at most: of linear systems the lowest natural frequency, of others that with which the coordinate is seen
to swing.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearSystem
from lcpstep.audit.limits import JUMP, RELEASED
from lcpstep.audit.sums import add_up, changes
from lcpstep.kernels.model import Model
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
PLACE, SPEED = 1.0 / 6.0, 1.0 / 12.0
LOOSE = 1e-12  # of the largest: natural frequencies squared that count as zero


def drift(
    run: Trajectory, m: Model, jumps: NDArray[np.bool_], closed: NDArray[np.bool_], cuts: Array
) -> Array:
    """An estimate of how far the computed positions are off in each piece, (m, n_q).

    jumps : (m + 1,)   whether the velocity may have jumped;  cuts : (k,)   corners, at which the steps stop
    closed : (m, n_c)   which contacts are closed in a piece
    """
    t, v, cuts = (np.ascontiguousarray(x, dtype=float) for x in (run.t, run.v, cuts))
    jump = begins(jumps, closed)
    first, second, gone = np.zeros((3, len(t) - 1, v.shape[1]))
    size = np.zeros(v.shape[1])
    changes(t, v, jump, cuts, first, second, size)
    h, held = np.diff(t)[:, None], frequency(run, m, size, second)
    second *= SPEED * h
    first *= PLACE * h * h
    add_up(t, jump, first, second, held, gone)
    return gone


def begins(jumps: NDArray[np.bool_], closed: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """At which states motions begin anew, (m + 1,): at jumps, and at a release before which every contact was closed.

    Such a gap is zero there, whatever steps on the obstacle have missed, and accelerations before and after it are
    not those of one motion.
    """
    shut: NDArray[np.bool_] = np.all(closed, axis=1)
    found: NDArray[np.uint8] = np.array(jumps, dtype=np.uint8) * np.uint8(JUMP)
    found[1:-1][shut[:-1] & ~shut[1:] & (found[1:-1] == 0)] = RELEASED
    return found


def frequency(run: Trajectory, m: Model, size: Array, second: Array) -> Array:
    """What holds the coordinates [rad/s], (n_q,); 0 where nothing does."""
    n = run.scene.n_q
    if isinstance(run.scene.system, LinearSystem):
        M, K = (np.asarray(m.arrays[x], dtype=float).reshape(n, n) for x in ("M", "K"))
        squares = np.linalg.eigvals(np.linalg.solve(M, K)).real
        lowest = float(np.min(squares))
        return np.full(n, np.sqrt(lowest) if lowest > LOOSE * float(np.max(np.abs(squares))) else 0.0)
    h = np.diff(run.t)[:, None]
    with np.errstate(all="ignore"):
        bent = np.sum(np.where(h > 0.0, second / h, 0.0), axis=0)
        return np.sqrt(finite(bent / size))


def finite(x: Array) -> Array:
    """Zero where it is no number."""
    return np.where(np.isfinite(x), x, 0.0)
