"""How far the energy of a run with friction is from the work of its friction, which the law gives at every state.

    T + V (t) - T + V (0) = work of the forces + integral of sum_c lambda_T (T v) dt      between impacts

The forces lambda_T are those of the modes at hand (`events.contacts.point`), at nodes of Gauss' rule between two
kept states; what the run itself has summed up as friction impulses is not looked at.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lcpstep.diagnostics import energy
from lcpstep.events.codes import OPEN, SLIDES, STICKS
from lcpstep.events.contacts import point
from lcpstep.events.contacts.run import start
from lcpstep.events.contacts.smooth import Smooth
from lcpstep.kernels.gauss import gauss
from lcpstep.trajectory import Kind, Trajectory

NODES = 6  # of Gauss' rule
ROUNDING = 1e-12  # tolerance of the modes at a state
SLIDING = 1e-9  # of the largest velocity: less than that is none


def unbalanced(run: Trajectory, total: Any = None) -> float:
    """The largest sum of what the balance leaves between impacts, relative to the largest energy.

    total : (q, v) -> energies (n,) [J] where all forces have a potential; what `lcpstep.energy` says if not given
    """
    balance, s = energy(run), start(run.scene, Smooth, ROUNDING, ROUNDING)
    struck = run.impacts.time[np.isin(run.impacts.kind, (Kind.IMPACT, Kind.ACCUMULATION))]
    hit = np.isin(run.t[1:], struck)
    energies = balance.total - balance.work + balance.damping if total is None else total(run.q, run.v)
    left = np.diff(energies) - [_work(s, run, k) for k in range(len(run.t) - 1)]
    size = float(np.max(balance.kinetic + np.abs(balance.potential)))
    return float(np.max(np.abs(np.cumsum(np.where(hit, 0.0, left))))) / size


def _work(s: Any, run: Trajectory, k: int) -> float:
    """Work of friction from one kept state to the next."""
    nodes, weights = gauss(NODES)
    t = run.t[k] + nodes * (run.t[k + 1] - run.t[k])
    states = np.hstack(run.at(t))
    n, n_c, n_j = run.scene.n_q, run.scene.n_c, run.scene.n_j
    closed = run.impulse[k + 1] > 0.0
    if not np.any(closed):
        return 0.0
    middle = states[len(states) // 2].copy()
    R, _, rate, _ = point.rows(s, float(t[len(t) // 2]), middle)
    slip = (R @ middle[n:] + rate)[n_j + n_c :]
    slides = np.abs(slip) > SLIDING * np.max(np.abs(run.v))
    modes = np.where(closed, np.where(slides, SLIDES, STICKS), OPEN)
    if not point.hold(s, float(t[len(t) // 2]), middle, modes, np.sign(slip)):
        return 0.0
    total = 0.0
    for time, x, weight in zip(t, states, weights * (run.t[k + 1] - run.t[k]), strict=True):
        x = np.ascontiguousarray(x)
        R, _, _, _ = point.rows(s, float(time), x)
        total += weight * float(point.forces(s, float(time), x)[n_j + n_c :] @ (R @ x[n:])[n_j + n_c :])
    return total
