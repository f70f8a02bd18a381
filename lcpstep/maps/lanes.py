"""Many time-stepping runs in lockstep, as kernels: time in the outer loop, the runs in the inner one.

For one linear degree of freedom with one flat contact the forcing and the obstacle depend on time alone and are
evaluated once for all runs, whose states lie side by side in memory. The arithmetic of a step is that of a single
run to the last bit, in the same order, so a run does not depend on the company it is in.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.kernels.dynamics import external_force, obstacle
from lcpstep.kernels.model import Model
from lcpstep.kernels.vectors import copy
from lcpstep.maps.answers import Answers
from lcpstep.pointers import Doubles, abs, inf, max
from lcpstep.stepping.steps import TOUCHING
from lcpstep.stepping.theta_method.moving import Plan


class Lanes:
    """States of m runs side by side.

    q, v, g, u : (m,)   states, gaps and gap velocities
    p, before           impulse of the step, gap velocity at its start
    slack               a predicted gap this small is closed
    free                velocities without impulses
    closed              for how many steps the contact has been closed
    h, theta, A_f, A_q, A_v, A_g, W     of the step, see `lcpstep.stepping.theta_method.moving`
    nobody, force : (1,)    a state for functions that depend on time alone; what they give

    Parameters
    ----------
    arrays : dict   q, v, g, u, p, before and slack by name, (m,)
    """

    def __init__(self, arrays: dict[str, Any]) -> None:
        self.n, self.arrays = len(arrays["q"]), arrays
        self.space, self.own = np.zeros(2), np.zeros((2, self.n))
        self.q, self.v = doubles(arrays["q"]), doubles(arrays["v"])
        self.g, self.u = doubles(arrays["g"]), doubles(arrays["u"])
        self.p, self.before, self.slack = (
            doubles(arrays["p"]),
            doubles(arrays["before"]),
            doubles(arrays["slack"]),
        )
        self.closed, self.free = doubles(self.own[0]), doubles(self.own[1])
        self.nobody, self.force = doubles(self.space[:1]), doubles(self.space[1:])

    @cython.ccall
    def take(self, plan: Plan) -> None:
        """Steps as the plan says."""
        self.h, self.theta = plan.h, plan.theta
        self.A_f, self.A_q, self.A_v = plan.A_f[0], plan.A_q[0], plan.A_v[0]
        self.A_g, self.W = plan.X[0], plan.W[0]


@cython.ccall
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
            take_step(m, lanes, f, lanes.force[0])
            if k >= 0:
                note_impacts(lanes, a, t_next, k)
            count_closed(lanes.closed, lanes.p, lanes.n)
            f = lanes.force[0]


@cython.ccall
def note_touching(m: Model, lanes: Lanes, side: float) -> None:
    """Contacts that begin at rest at next to no gap are closed: see `lcpstep.stepping.theta_method.theta_loop`."""
    external_force(m, side, lanes.nobody, lanes.nobody, lanes.force)
    force = abs(lanes.force[0])
    if not m.force.given:
        force = max(force, abs(m.constant[0]) + abs(m.cosine[0]) + abs(m.sine[0]))
    for i in range(lanes.n):
        pushed = abs(lanes.A_f) * force + abs(lanes.A_q * lanes.q[i]) + abs(lanes.A_v * lanes.v[i])
        near = TOUCHING * lanes.h * pushed
        if near < inf and abs(lanes.g[i]) <= near and lanes.h * abs(lanes.u[i]) <= near:
            lanes.slack[i] = max(lanes.slack[i], near)


def take_step(m: Model, lanes: Lanes, f: float, f_next: float) -> None:
    """One step of all runs; forces at its start and end.

    In loops of their own, so that the compiler sees few enough arrays at a time to treat several runs at once.
    """
    push = lanes.A_f * (lanes.theta * f_next + (1.0 - lanes.theta) * f)
    s, ds = m.motion_now[0], m.motion_now[1]
    find_free(lanes.free, lanes.q, lanes.v, push, lanes.A_q, lanes.A_v, lanes.n)
    find_impulses(
        lanes.p, lanes.free, lanes.g, lanes.u, lanes.slack, m.G[0], ds, m.restitution[0], lanes.W, 0.5 * lanes.h,
        lanes.n,
    )  # fmt: skip
    copy(lanes.before, lanes.u, lanes.n)
    move(lanes.q, lanes.v, lanes.free, lanes.p, lanes.A_g, lanes.h, lanes.theta, lanes.n)
    measure(lanes.g, lanes.u, lanes.q, lanes.v, m.G[0], m.offset[0] - s, ds, lanes.n)


def find_free(free: Doubles, q: Doubles, v: Doubles, push: float, A_q: float, A_v: float, n: int) -> None:
    """Velocities at the end of the step without impulses."""
    for i in range(n):
        free[i] = v[i] + (push - A_q * q[i] - A_v * v[i])


def find_impulses(
    p: Doubles, free: Doubles, g: Doubles, u: Doubles, slack: Doubles, G: float, ds: float, r: float, W: float,
    half: float, n: int,
) -> None:  # fmt: skip
    """Impulses of contacts that are predicted to be closed half a step on."""
    for i in range(n):
        b = G * free[i] + -ds + r * u[i]
        z = max(0.0, -b / W)
        p[i] = z if g[i] + half * u[i] <= slack[i] else 0.0


def move(
    q: Doubles, v: Doubles, free: Doubles, p: Doubles, A_g: float, h: float, theta: float, n: int
) -> None:
    """States at the end of the step."""
    for i in range(n):
        v_next = free[i] + A_g * p[i]
        q[i] = q[i] + h * (theta * v_next + (1.0 - theta) * v[i])
        v[i] = v_next


def measure(
    g: Doubles, u: Doubles, q: Doubles, v: Doubles, G: float, height: float, ds: float, n: int
) -> None:
    """Gaps and gap velocities."""
    for i in range(n):
        g[i] = height + G * q[i]
        u[i] = G * v[i] - ds


def count_closed(closed: Doubles, p: Doubles, n: int) -> None:
    """For how many steps each contact has been closed."""
    for i in range(n):
        closed[i] = closed[i] + 1.0 if p[i] > 0.0 else 0.0


def note_impacts(lanes: Lanes, a: Answers, t: float, k: int) -> None:
    """Impacts of the step, and beginnings of lasting contact."""
    for i in range(lanes.n):
        if lanes.p[i] > 0.0:
            if lanes.closed[i] == 0.0:
                a.note_impact(i, k, t, lanes.before[i], lanes.u[i])
            elif lanes.closed[i] == 1.0:
                a.note_landing(i, k, t)
