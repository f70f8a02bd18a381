"""Many time-stepping runs in lockstep, as kernels: time in the outer loop, the runs in the inner one.

For one linear degree of freedom with one flat contact the forcing and the obstacle depend on time alone and are
evaluated once for all runs, whose states lie side by side in memory. The arithmetic of a step is that of a single
run to the last bit, in the same order, so a run does not depend on the company it is in.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.kernels.dynamics import external_force, obstacle
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.vectors import copy
    from lcpstep.maps.answers import Answers
    from lcpstep.pointers import max, min
    from lcpstep.stepping.theta_method.plan import Plan

OPEN, STRUCK = 0.0, 1.0  # and 2: closed for several steps


class Lanes:
    """States of m runs side by side.

    q, v, g, u : (m,)   states, gaps and gap velocities
    p, before           impulse of the step, gap velocity at its start
    slack               a predicted gap this small is closed
    closed              OPEN, STRUCK in the last step, or 2: closed for several
    h, theta, A_f, A_q, A_v, A_g, W     of the step, see `lcpstep.stepping.theta_method.plan`
    nobody, force : (1,)    a state for functions that depend on time alone; what they give

    Parameters
    ----------
    arrays : dict   q, v, g, u, p, before and slack by name, (m,)
    """

    def __init__(self, arrays: dict[str, Any]) -> None:
        self.n, self.arrays = len(arrays["q"]), arrays
        self.space, self.marks = np.zeros(2), np.zeros(self.n)
        self.q, self.v = doubles(arrays["q"]), doubles(arrays["v"])
        self.g, self.u = doubles(arrays["g"]), doubles(arrays["u"])
        self.p, self.before, self.slack = (
            doubles(arrays["p"]),
            doubles(arrays["before"]),
            doubles(arrays["slack"]),
        )
        self.closed = doubles(self.marks)
        self.nobody, self.force = doubles(self.space[:1]), doubles(self.space[1:])

    def take(self, plan: Plan) -> None:
        """Steps as the plan says."""
        self.h, self.theta = plan.h, plan.theta
        self.A_f, self.A_q, self.A_v = plan.A_f[0], plan.A_q[0], plan.A_v[0]
        self.A_g, self.W = plan.X[0], plan.W[0]


def advance(
    m: Model, lanes: Lanes, a: Answers, t0: float, side: float, first: int, begin: int, last: int, k: int
) -> None:
    """Steps begin .. last - 1 of all runs; called from Python.

    k : the kept period in which impacts are noted; none where it is negative
    t0, first : a time, and the step that begins there
    side : the time at which step `begin` begins, or just after it where that is a corner
    """
    with cython.nogil:
        external_force(m, side, lanes.nobody, lanes.nobody, lanes.force)
        f = lanes.force[0]
        for step in range(begin, last):
            t_next = t0 + lanes.h * (step + 1 - first)
            external_force(m, t_next, lanes.nobody, lanes.nobody, lanes.force)
            obstacle(m, t_next, lanes.nobody, lanes.nobody)
            strike(m, lanes, f, lanes.force[0])
            take_step(m, lanes, f, lanes.force[0])
            if k >= 0:
                note_impacts(lanes, a, t_next, k)
            mark_closed(lanes)
            f = lanes.force[0]


def strike(m: Model, lanes: Lanes, f: float, f_next: float) -> None:
    """Impulses of a step of all runs; forces at its start and end.

    In loops of their own, so that the compiler sees few enough arrays at a time to treat several runs at once.
    """
    h, theta = lanes.h, lanes.theta
    A_f, A_q, A_v, W = lanes.A_f, lanes.A_q, lanes.A_v, lanes.W
    G, r, ds = m.G[0], m.restitution[0], m.motion_now[1]
    q, v, g, u, p, slack = lanes.q, lanes.v, lanes.g, lanes.u, lanes.p, lanes.slack
    for i in range(lanes.n):
        v_free = v[i] + (A_f * (theta * f_next + (1.0 - theta) * f) - A_q * q[i] - A_v * v[i])
        b = G * v_free + -ds + r * u[i]
        z = max(0.0, -b / W)
        p[i] = z if g[i] + 0.5 * h * u[i] <= slack[i] else 0.0


def take_step(m: Model, lanes: Lanes, f: float, f_next: float) -> None:
    """A step of all runs with these impulses."""
    h, theta = lanes.h, lanes.theta
    A_f, A_q, A_v, A_g = lanes.A_f, lanes.A_q, lanes.A_v, lanes.A_g
    G, offset, s, ds = m.G[0], m.offset[0], m.motion_now[0], m.motion_now[1]
    q, v, g, u, p, before = lanes.q, lanes.v, lanes.g, lanes.u, lanes.p, lanes.before
    copy(before, u, lanes.n)
    for i in range(lanes.n):
        v_free = v[i] + (A_f * (theta * f_next + (1.0 - theta) * f) - A_q * q[i] - A_v * v[i])
        v_next = v_free + A_g * p[i]
        q_next = q[i] + h * (theta * v_next + (1.0 - theta) * v[i])
        q[i], v[i] = q_next, v_next
        g[i] = offset - s + G * q_next
        u[i] = G * v_next - ds


def note_impacts(lanes: Lanes, a: Answers, t: float, k: int) -> None:
    """Impacts of the step, and beginnings of lasting contact."""
    for i in range(lanes.n):
        if lanes.p[i] > 0.0:
            if lanes.closed[i] == OPEN:
                a.note_impact(i, k, t, lanes.before[i], lanes.u[i])
            elif lanes.closed[i] == STRUCK:
                a.note_landing(i, k, t)


def mark_closed(lanes: Lanes) -> None:
    """How long each contact has been closed: a step longer, or not at all."""
    p, closed = lanes.p, lanes.closed
    for i in range(lanes.n):
        struck = 1.0 if p[i] > 0.0 else 0.0
        closed[i] = min(closed[i] + 1.0, 2.0) * struck
