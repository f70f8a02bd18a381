"""Whether implicit steps of a finished run of a linear system see the oscillations that it carries.

    sum of (dv^T M dv + dq^T K dq)  <=  2 x sum of (v^T M v + x^T K x)         over steps without an impact

where x is q less its mean. An oscillation that turns by the angle a in a step has 4 sin^2(a/2) on the left for each 1
on the right. Forces taken implicitly leave it its energy, and turn it by 2 atan(w h/2): by less than half a period
however fast it is, so that whatever is faster seems to have the period 2h, and q goes to and fro between two steps.
Beyond a quarter of a period nothing of it is right but its energy; so it is with dampers, that turn a velocity round
where they should stop it. Springs may be as stiff as they like while they carry but a small part of the energy, or
hold a load at rest: then they are rods. Steps of theta < 1/2 also feed all oscillations, each by

    (1/2 - theta) (dv^T M dv + dq^T K dq)

That is told where it is a part of the energy (`balance`). Steps by a tolerance are not asked, nor those that follow
linear forces in closed form, or explicitly (`resolution`).
Source: T. J. R. Hughes, The Finite Element Method (2000), section 9.3: period elongation of the trapezoidal rule.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from lagrangian import LinearSystem
from lcpstep.doubts.balance import in_words
from lcpstep.doubts.depth import fixed_step, spread
from lcpstep.trajectory import Status, Trajectory

LOOKS = 64  # steps that are looked at
BOUND = 2.0  # a quarter of a period in each step
# How many of these have so much of the largest energy: else it has died away at once
LEAST, SHARE = 8, 1e-3
LOAD = 0.01  # of the energy of what springs bear at rest: less is no motion beside it
GROWS = 4.0  # in a step: what no oscillation does
LENGTH = 1e-6  # of a step: of times


def overleapt(run: Trajectory) -> str | None:
    """By how much oscillations turn in a step, in words; "" where steps see them, None where they are explicit."""
    scene, order = run.scene, getattr(run.method, "order", None)
    system = scene.system
    if order == 4 or order == "exact" or not isinstance(system, LinearSystem):
        return None
    rubs = scene.contacts is not None and scene.contacts.friction is not None
    if order == 2 and (rubs or scene.n_j > 0):
        return None
    if run.counts.steps <= LEAST or len(run.t) <= LEAST or run.status != Status.DONE:
        return ""
    h = fixed_step(run.method)
    if h == 0.0:
        return ""
    return (_skipped(run, system, h) if _stiff(run, h) else "") or _fed(run, system, h)


def _steps(run: Trajectory, h: float) -> tuple[Any, int]:
    """Kept states from which a step of h without an impact leads to the next, of so many that are looked at."""
    k = spread(0, len(run.t) - 2, LOOKS)
    return k[(np.abs(run.t[k + 1] - run.t[k] - h) < LENGTH * h) & ~run.impulse[k + 1].any(axis=1)], len(k)


def _fed(run: Trajectory, system: LinearSystem, h: float) -> str:
    """How much energy steps of theta < 1/2 have given what oscillates, in words; not what falls."""
    less, K = 0.5 - getattr(run.method, "theta", 0.5), cast(Any, system.K)
    k, looks = _steps(run, h)
    if less <= 0.0 or len(k) == 0 or not abs(K).sum() > 0.0:
        return ""
    q, v, times = run.q, run.v, run.counts.steps / looks
    before, after = (0.5 * _energy(system, q[i], v[i]) for i in (k, k + 1))
    given = less * np.sum(_energy(system, q[k + 1] - q[k], v[k + 1] - v[k]))
    return in_words(times * given, np.max(after) + times * np.sum(np.abs(after - before)))


def _skipped(run: Trajectory, system: LinearSystem, h: float) -> str:
    """The same of steps h, as the states at both their ends tell."""
    k, _ = _steps(run, h)
    if len(k) < LEAST:
        return ""
    q, v, rest = run.q, run.v, np.mean(run.q[k], axis=0)
    before, after = _energy(system, q[k] - rest, v[k]), _energy(system, q[k + 1] - rest, v[k + 1])
    # What turns in a step is not what the step itself has made
    energy = np.where(after > GROWS * before, before, 0.5 * (before + after))
    told = energy > SHARE * np.max(energy)
    total = float(np.sum(energy[told]))
    dies_away = np.count_nonzero(told) < LEAST and not told[-1]  # and does not grow beyond all of the start
    if dies_away or not total > LOAD * float(np.sum(_energy(system, q[k], v[k])[told])):
        return ""
    ratio = float(np.sum(_energy(system, q[k + 1] - q[k], v[k + 1] - v[k])[told])) / total
    if not ratio > BOUND:
        return ""
    angle = 2.0 * np.arcsin(min(1.0, 0.5 * np.sqrt(ratio)))
    return (
        f"what springs and dampers move turns by {angle:.3g} radian in each step of {h:.3g} s, or by more than "
        "steps can tell: they are too long for this motion"
    )


def _stiff(run: Trajectory, h: float) -> bool:
    """Whether a step may be that long for some oscillation, by bounds where there is a dense model."""
    from lcpstep.kernels.looks import at_most
    from lcpstep.model import at_hand

    m = at_hand(run.scene)
    if m is None:
        return True
    springs, dampers = at_most(m)
    if h * h * springs <= 4.0 and h * dampers <= 2.0:
        return False
    inverse, C, K = (m.arrays[name] for name in ("M_inverse", "C", "K"))
    return h * h * _largest(inverse @ K) > 4.0 or h * _largest(inverse @ C) > 2.0


def _largest(A: Any) -> float:
    """The largest sum of magnitudes of a row: no eigenvalue is larger."""
    return float(np.max(np.sum(np.abs(A), axis=1)))


def _energy(system: LinearSystem, q: Any, v: Any) -> Any:
    """Twice the kinetic and elastic energy of every state (n, n_q), the latter of springs that push away as well."""
    matrices: Any = system.M, system.K
    M, K = matrices
    return np.sum(v * (M @ v.T).T, axis=1) + np.abs(np.sum(q * (K @ q.T).T, axis=1))
