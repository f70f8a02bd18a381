"""What velocities and accelerations of contacts are made of, as kernels: sums of terms, their signs left aside.

A speed or an acceleration is but rounding if it is small beside these. Beside itself, or beside a sum that has
cancelled, it never is: speeds that fall from impact to impact by a factor would be followed down to 1e-308.
Source: N. Higham, Accuracy and Stability of Numerical Algorithms, section 3.1.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import harmonic_terms
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import product
from lcpstep.pointers import Doubles, abs
from lcpstep.stepping.pieces.state import Plan, Work

FAINT = 1e-10  # of the velocities that have acted in a step: the end of a sequence of events at one instant
LEAST = 1e-290  # numbers near the smallest ones have no relative rounding


def velocity_of(w: Work, c: int) -> float:
    """The velocity of gap c by the rows and velocities at hand."""
    return product(w.G, w.v, c, w.n_q) + w.gap_t[c]


def with_terms(w: Work, G: Doubles, c: int, x: Doubles, constant: float) -> tuple[float, float]:
    """The constant and G_c x, over the coordinates that move gap c; and what the sum is made of, signs left aside."""
    total, size = constant, abs(constant)
    for i in range(w.first_coordinate[c], w.last_coordinate[c] + 1):
        term = G[c * w.n_q + i] * x[i]
        total, size = total + term, size + abs(term)
    return total, size


def speed_terms(plan: Plan, w: Work, c: int) -> float:
    """What a gap velocity is made of in this step, signs left aside: velocities, impulses, accelerations.

    Its rounding is measured against that: a speed that falls from impact to impact would never be found small
    beside itself.
    """
    size = LEAST + abs(w.gap_t[c])
    for i in range(w.first_coordinate[c], w.last_coordinate[c] + 1):
        size += abs(w.G[c * w.n_q + i]) * (w.swing[i] + abs(w.v[i]) + plan.h * abs(w.a_free[i]))
    return size


def faint(plan: Plan, w: Work, c: int, u: float) -> bool:
    """Whether a gap velocity is next to nothing beside what has acted in this step."""
    return abs(u) <= FAINT * speed_terms(plan, w, c)


def acceleration_terms(m: Model, w: Work, c: int) -> float:
    """What the acceleration of a gap without contact forces is made of, signs left aside."""
    acting(m, w)
    size = LEAST + abs(w.bias[c])
    for i in range(w.n_q):
        size += abs(w.G[c * w.n_q + i]) * w.a_try[i]
    return size


def acting(m: Model, w: Work) -> None:
    """What the terms of the accelerations without contact add up to, their signs left aside, into w.a_try.

    Their sum may be zero where a spring carries a weight; what rounds is each of them. Of a force that the scene
    gives as a whole nothing finer is known.
    """
    n = w.n_q
    for i in range(n):
        w.jolt[i] = 0.0 if m.mass.given else abs(w.force[i])
        if m.linear:
            w.jolt[i] += harmonic_terms(m, i)
            for j in range(m.C_ends[2 * i], m.C_ends[2 * i + 1]):
                w.jolt[i] += abs(m.C[i * m.n_q + j] * w.v[j]) + abs(m.K[i * m.n_q + j] * w.q[j])
    for i in range(n):
        w.a_try[i] = abs(w.a_free[i])
        if not m.mass.given:
            for j in range(m.M_ends[2 * i], m.M_ends[2 * i + 1]):
                w.a_try[i] += abs(m.M_inverse[i * m.n_q + j]) * w.jolt[j]
