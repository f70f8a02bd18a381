"""What velocities and accelerations of contacts are made of, as kernels: sums of terms, their signs left aside.

A speed or an acceleration is but rounding if it is small beside these. Beside itself, or beside a sum that has
cancelled, it never is: speeds that fall from impact to impact by a factor would be followed down to 1e-308.
Source: N. Higham, Accuracy and Stability of Numerical Algorithms, section 3.1.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.model import ABSENT
from lcpstep.stepping.located_work import (
    A_TRY,
    BIAS,
    FIRST_COORDINATE,
    FORCE,
    FREE,
    GAP_T,
    JOLT,
    LAST_COORDINATE,
    SWING,
    Q,
    V,
)

FAINT = 1e-10  # of the velocities that have acted in a step: the end of a sequence of events at one instant


@inline
def speed_terms(plan: Any, w: Any, c: int) -> float:
    """What a gap velocity is made of in this step, signs left aside: velocities, impulses, accelerations.

    Its rounding is measured against that: a speed that falls from impact to impact would never be found small
    beside itself.
    """
    size = abs(w.num[GAP_T, c])
    for i in range(w.mark[FIRST_COORDINATE, c], w.mark[LAST_COORDINATE, c] + 1):
        size += abs(w.G[c, i]) * (w.vec[SWING, i] + abs(w.vec[V, i]) + plan.h * abs(w.vec[FREE, i]))
    return size


@inline
def faint(plan: Any, w: Any, c: int, u: float) -> bool:
    """Whether a gap velocity is next to nothing beside what has acted in this step."""
    return abs(u) <= FAINT * speed_terms(plan, w, c)


def acceleration_terms(m: Any, w: Any, c: int) -> float:
    """What the acceleration of a gap without contact forces is made of, signs left aside."""
    acting(m, w)
    size = abs(w.num[BIAS, c])
    for i in range(w.vec.shape[1]):
        size += abs(w.G[c, i]) * w.vec[A_TRY, i]
    return size


def acting(m: Any, w: Any) -> None:
    """What the terms of the accelerations without contact add up to, their signs left aside, into w.vec[A_TRY].

    Their sum may be zero where a spring carries a weight; what rounds is each of them. Of a force that the scene
    gives as a whole nothing finer is known.
    """
    n = w.vec.shape[1]
    for i in range(n):
        w.vec[JOLT, i] = 0.0 if m.mass != ABSENT else abs(w.vec[FORCE, i])
        if m.linear:
            if m.force == ABSENT:
                w.vec[JOLT, i] += abs(m.constant[i]) + abs(m.cosine[i]) + abs(m.sine[i])
            for j in range(n):
                w.vec[JOLT, i] += abs(m.C[i, j] * w.vec[V, j]) + abs(m.K[i, j] * w.vec[Q, j])
    for i in range(n):
        w.vec[A_TRY, i] = abs(w.vec[FREE, i])
        if m.mass == ABSENT:
            for j in range(n):
                w.vec[A_TRY, i] += abs(m.M_inverse[i, j]) * w.vec[JOLT, j]
