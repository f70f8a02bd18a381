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

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearSystem
from lcpstep.kernels.model import Model
from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
PLACE, SPEED = 1.0 / 6.0, 1.0 / 12.0
LOOSE = 1e-12  # of the largest: natural frequencies squared that count as zero


def drift(run: Trajectory, m: Model, jumps: NDArray[np.bool_], cuts: Array) -> Array:
    """An estimate of how far the computed positions are off in each piece, (m, n_q).

    jumps : (m + 1,)   whether the velocity may have jumped;  cuts : (k,)   corners, at which the steps stop
    """
    h = np.diff(run.t)[:, None]
    with np.errstate(all="ignore"):
        a = np.diff(run.v, axis=0) / h
    cut = np.searchsorted(cuts, run.t[1:], side="right") > np.searchsorted(cuts, run.t[:-1])
    smooth = np.isfinite(a) & ~(jumps[1:] | cut)[:, None]
    a = np.where(smooth, a, 0.0)
    turn = np.zeros(
        (len(h) + 1, a.shape[1])
    )  # at the states: how the acceleration changes from piece to piece
    turn[1:-1] = np.where(smooth[1:] & smooth[:-1], np.diff(a, axis=0), 0.0)
    known = np.zeros(turn.shape, dtype=bool)
    known[1:-1] = smooth[1:] & smooth[:-1]
    first = np.maximum(np.abs(turn[1:]), np.abs(turn[:-1]))
    second = np.where(known[1:] & known[:-1], np.abs(np.diff(turn, axis=0)), 0.0)
    first, second = beside(first), beside(second)
    place, speed = PLACE * h * h * first, SPEED * h * second
    start = np.maximum.accumulate(np.where(jumps[:-1], np.arange(len(h)), 0))
    t = (run.t[:-1] - run.t[0])[:, None]
    passed = np.diff(run.t, append=0.0)[:-1, None] + t  # at the end of the piece
    off, gone, moment = (since(x, start) for x in (place, speed, speed * t))
    with np.errstate(all="ignore"):
        held = gone / frequency(run, m, a, second, h)
    return np.asarray(off + np.fmin(np.maximum(passed * gone - moment, 0.0), held))


def beside(x: Array) -> Array:
    """The largest of each piece and its neighbours."""
    most = x.copy()
    np.maximum(most[1:], x[:-1], out=most[1:])
    np.maximum(most[:-1], x[1:], out=most[:-1])
    return most


def since(x: Array, start: Any) -> Array:
    """Sums up to the end of each piece, from the pieces `start` on."""
    total = np.cumsum(x, axis=0)
    return np.asarray(total - (total - x)[start])


def frequency(run: Trajectory, m: Model, a: Array, second: Array, h: Array) -> Any:
    """What holds the coordinates [rad/s]; 0 where nothing does."""
    if isinstance(run.scene.system, LinearSystem):
        n = run.scene.n_q
        M, K = (np.asarray(m.arrays[x], dtype=float).reshape(n, n) for x in ("M", "K"))
        squares = np.linalg.eigvals(np.linalg.solve(M, K)).real
        lowest = float(np.min(squares))
        return np.sqrt(lowest) if lowest > LOOSE * float(np.max(np.abs(squares))) else 0.0
    with np.errstate(all="ignore"):
        bent = np.where(h > 0.0, second / (h * h), 0.0)
    return np.sqrt(np.nan_to_num(np.sum(h * bent, axis=0) / np.sum(h * np.abs(a), axis=0)))
