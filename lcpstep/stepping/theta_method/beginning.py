"""Contacts that a run of the Moreau theta-method begins on: what counts as closed where no length tells."""

from __future__ import annotations

import cython

from lcpstep.kernels.acceleration import divide_by_mass
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy, largest
from lcpstep.pointers import abs, inf, max
from lcpstep.stepping.steps import TOUCHING
from lcpstep.stepping.theta_method.moving import Plan, State


def note_touching(m: Model, plan: Plan, s: State, t: float) -> None:
    """Contacts that begin at rest at next to no gap are closed up to a share of the way that forces push in a step.

    Such gaps are rounding of a motion before: all lengths may be zero, or rounding themselves.
    """
    near = TOUCHING * plan.h * pushed(m, plan, s, t)
    if not near < inf:
        return
    for i in range(s.n_c):
        if abs(s.g[i]) <= near and plan.h * abs(s.u[i]) <= near:
            s.slack[i] = max(s.slack[i], near)


def pushed(m: Model, plan: Plan, s: State, t: float) -> float:
    """The largest change of a velocity by the forces of a step, whose terms do not cancel; harmonic ones at most."""
    n = s.n_q
    if not m.linear:
        copy(s.try_v, s.force, n)
        known = divide_by_mass(m, t, s.q, s.v, s.A, s.R, s.try_v)
        return plan.h * largest(s.try_v, 0.0, n) if known else 0.0
    for j in range(n):
        s.try_f[j] = abs(s.force[j])
        if not m.force.given:
            s.try_f[j] = max(s.try_f[j], abs(m.constant[j]) + abs(m.cosine[j]) + abs(m.sine[j]))
    most = 0.0
    for i in range(n):
        total = 0.0
        for j in range(n):
            k = i * n + j
            total += abs(plan.A_f[k]) * s.try_f[j] + abs(plan.A_q[k] * s.q[j]) + abs(plan.A_v[k] * s.v[j])
        most = max(most, total)
    return most
