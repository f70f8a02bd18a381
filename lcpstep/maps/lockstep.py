"""Many time-stepping runs in lockstep: time in the outer loop, the runs in the inner one.

For one linear degree of freedom with one flat contact the forcing and the obstacle depend on time alone and are
evaluated once for all runs, whose states lie side by side in memory. The arithmetic of a step is that of
`stepping.theta` to the last bit, in the same order, so a run does not depend on the company it is in.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import by_address, compiled, inline
from lcpstep.dynamics import external_force, obstacle
from lcpstep.maps.follow import INSIDE, Task
from lcpstep.model import model
from lcpstep.pace import Pace
from lcpstep.stepping.moreau import Moreau, plan
from lcpstep.stepping.start import start_side
from lcpstep.stepping.steps import RESTING, divided
from lcpstep.stepping.theta import Plan
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
IMPACTS, ENDS = 0, 1  # places in the counts of a period
OPEN, STRUCK, CLOSED = range(3)
DONE, NOT_FINITE = 0, 1
PORTION = 65536  # steps between two looks at the outside world, at most
ROUNDING = 64 * np.finfo(float).eps
CODES = {DONE: Status.DONE, NOT_FINITE: Status.NOT_FINITE}


@by_address
class Lanes(NamedTuple):
    """States of all runs, each of shape (m,)."""

    q: Any
    v: Any
    g: Any
    u: Any
    p: Any  # impulse of the step
    before: Any  # gap velocity at its start
    slack: Any  # a predicted gap this small is closed
    closed: Any
    q0: Any  # (1,) nobody's state, for callbacks that depend on time alone
    force: Any  # (1,)


def advance(
    m: Any,
    plan: Any,
    lanes: Any,
    task: Any,
    t0: float,
    side: float,
    first: int,
    begin: int,
    last: int,
    k: int,
) -> None:
    """Kernel: steps begin .. last - 1 of all runs; their impacts are noted in the k-th kept period if k >= 0.

    t0, first : a time, and the step that begins there
    side : the time at which step `begin` begins, or just after it where that is a corner
    """
    h, theta = plan.h, plan.theta
    A_f, A_q, A_v, A_g, W = plan.A_f[0, 0], plan.A_q[0, 0], plan.A_v[0, 0], plan.A_g[0, 0], plan.W[0, 0]
    G, offset, r = m.G[0, 0], m.offset[0], m.restitution[0]
    q, v, g, u, p, before = lanes.q, lanes.v, lanes.g, lanes.u, lanes.p, lanes.before
    external_force(m, side, lanes.q0, lanes.q0, lanes.force)
    f = lanes.force[0]
    for step in range(begin, last):
        t_next = t0 + h * (step + 1 - first)
        external_force(m, t_next, lanes.q0, lanes.q0, lanes.force)
        f_next = lanes.force[0]
        obstacle(m, t_next, lanes.q0, lanes.q0)
        s, ds = m.motion_now[0, 0], m.motion_now[0, 1]
        for i in range(len(q)):
            v_next = v[i] + (A_f * (theta * f_next + (1.0 - theta) * f) - A_q * q[i] - A_v * v[i])
            b = G * v_next + -ds + r * u[i]
            z = max(0.0, -b / W)
            p[i] = z if g[i] + 0.5 * h * u[i] <= lanes.slack[i] else 0.0
            v_next = v_next + A_g * p[i]
            q[i] = q[i] + h * (theta * v_next + (1.0 - theta) * v[i])
            v[i] = v_next
            before[i] = u[i]
            g[i] = offset - s + G * q[i]
            u[i] = G * v_next - ds
        note_impacts(lanes, task, t_next, k)
        f = f_next


@inline
def note_impacts(lanes: Any, task: Any, t: float, k: int) -> None:
    """Impacts of the step, and beginnings of lasting contact."""
    for i in range(len(lanes.q)):
        if lanes.p[i] > 0.0:
            if lanes.closed[i] == OPEN and k >= 0:
                place = task.counts[i, k, IMPACTS]
                if place < task.impacts.shape[2]:
                    task.impacts[i, k, place, 0] = t
                    task.impacts[i, k, place, 1] = lanes.before[i]
                    task.impacts[i, k, place, 2] = lanes.u[i]
                task.counts[i, k, IMPACTS] += 1
            elif lanes.closed[i] == STRUCK and k >= 0:
                place = task.counts[i, k, ENDS]
                if place < task.landings.shape[2]:
                    task.landings[i, k, place] = t
                task.counts[i, k, ENDS] += 1
            lanes.closed[i] = min(CLOSED, lanes.closed[i] + 1)
        else:
            lanes.closed[i] = OPEN


class Lockstep:
    """A scene made ready for `advance`."""

    def __init__(self, scene: Scene, method: Moreau) -> None:
        self.scene, self.method = scene, method
        self.model, self.fast = model(scene)

    @property
    def usable(self) -> bool:
        """Whether all runs share forcing and obstacle: one linear degree of freedom, one flat contact."""
        m = self.model
        return bool(
            m.linear
            and m.flat
            and self.scene.n_q == 1
            and self.scene.n_c == 1
            and self.method.lcp == "lemke"
            and self.method.tolerance is None
        )

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task."""
        kernel = compiled(advance) if self.fast else advance
        m, x = self.model, task.starts
        zeros = {name: np.zeros(len(x)) for name in ("g", "u", "p", "before", "slack")}
        lanes = Lanes(
            q=x[:, 0].copy(), v=x[:, 1].copy(), closed=np.zeros(len(x), dtype=np.int64), q0=np.zeros(1),
            force=np.zeros(1), **zeros,
        )  # fmt: skip
        self.measure(lanes, task.t_start)
        size = np.maximum(1.0, np.abs(lanes.q))
        if strict:
            task.codes[lanes.g < -ROUNDING * size] = INSIDE
        stretches = list(self.stretches(task.t_start, task.t_end))
        pace, done = Pace(PORTION, len(x)), 0
        for period in range(task.periods):
            k = period - task.drop
            self.measure(lanes, task.t_start)
            for p, t0, first, last in stretches:
                begin, side = first, start_side(self.scene, t0)
                while begin < last:
                    until = min(last, begin + pace.goal(done) - done)
                    kernel(m, p, lanes, task, t0, side, first, begin, until, k)
                    done += until - begin
                    begin, side = until, t0 + p.h * (until - first)
            if k >= 0:
                task.states[:, k, 0], task.states[:, k, 1] = lanes.q, lanes.v
        task.final[:, 0], task.final[:, 1] = lanes.q, lanes.v
        task.taken[:] = task.periods
        lost = ~np.all(np.isfinite(task.final), axis=1) & (task.codes == DONE)
        task.codes[lost] = NOT_FINITE
        task.taken[task.codes == INSIDE] = 0

    def measure(self, lanes: Lanes, t: float) -> None:
        """Gaps, gap velocities and what counts as closed, at the start of a period."""
        m = self.model
        s = np.zeros((1, 3))
        if self.scene.contacts.motion is not None:  # type: ignore[union-attr]
            side = start_side(self.scene, t)
            self.scene.contacts.motion(side, lanes.q0, lanes.q0, m.p, s)  # type: ignore[union-attr]
        G, offset = m.G[0, 0], m.offset[0]
        lanes.g[:] = offset - s[0, 0] + G * lanes.q
        lanes.u[:] = G * lanes.v - s[0, 1]
        size = np.maximum(np.maximum(np.abs(lanes.q), abs(offset)), np.abs(self.method.h * lanes.v))
        lanes.slack[:] = RESTING * np.where(size == 0.0, 1.0, size)

    def stretches(self, t_start: float, t_end: float) -> Iterator[tuple[Plan, float, int, int]]:
        """The steps of a span, as `Moreau` takes them: whole ones, and a shorter last one where they do not fit."""
        for h, t0, first, last in divided((t_start, t_end), self.method.h):
            yield plan(self.model, h, self.method.theta, 0.0), t0, first, last
