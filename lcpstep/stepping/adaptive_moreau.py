"""Steps of `Moreau` chosen by a tolerance: what one step and its two halves do, as a kernel.

Beside the difference of the two runs these count as errors, for both may agree on what is wrong:

    h |v+ - v|       position, in steps with an impact: its place in the step is not known
    |v_free - v|     velocity, in these steps: what the forces do from the start of the step to the impact
    depth            by which a contact without impulse has gone below its obstacle, or has been below in between

and what releases and friction hide (`adaptive_switches`).
Their velocities are not compared: an impact that one run sees and the other just after the end is no error. So the
step before an impact is halved until it is short, which costs the logarithm of its length. A contact that closes
slower than the tolerance resolves is closed without rebound, so that chattering ends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from lcpstep.compiled import by_address, compiled, inline
from lcpstep.model import Model
from lcpstep.recording import Record, write_row
from lcpstep.stepping.adaptive import (
    ACCEPTED,
    AGAIN,
    GIVEN_UP,
    LEAST_SHARE,
    LEVEL,
    LEVELS,
    PAUSED,
    SIZE_Q,
    SIZE_V,
    SPAN,
    TOO_SMALL,
    TRIED,
    UNTIL,
    Control,
    distance,
    goal,
    judge,
    largest,
    now,
    over,
    resolved,
    stamp,
    step_size,
)
from lcpstep.stepping.adaptive_switches import Switches, begin, note, unseen
from lcpstep.stepping.constrained import Constraints
from lcpstep.stepping.constrained import run as run_constrained
from lcpstep.stepping.newton import linearise
from lcpstep.stepping.theta import (
    EVENT,
    FINISHED,
    FORCES,
    LATE,
    LCP_CALLS,
    LOG_FULL,
    NEXT_TIME,
    ROW,
    STEP,
    Plan,
    State,
)
from lcpstep.stepping.theta import run as run_contacts

# Rows of Saved.vec: the state at the start of the step, where the one step led, the start of the part at hand
Q, V, FORCE, ONE_Q, ONE_V, PART_Q, PART_V, BETWEEN_Q, BETWEEN_V = range(9)
# Rows of Saved.num, a number per contact: at the start of the step, and of the part; the scene's own restitution
GAP, RATE, PART_GAP, PART_RATE, RESTITUTION = range(5)
# Places in Saved.done: errors of position and velocity, whether anything happened at contacts or was struck, whether
# a step is under way
APART_Q, APART_V, HAPPENED, STRUCK, UNDER_WAY = range(5)
WANTED = -3  # why the loop returned: for the matrices of a level
MATRICES = ("A_q", "A_v", "A_f", "A_g", "W")  # of a plan, that depend on h


@by_address
class Levels(NamedTuple):
    """What steps of every level multiply with, as in `theta.Plan`; one room for all where that changes anyhow."""

    theta: float
    slack: float
    constant: bool
    ready: Any  # (LEVELS + 2,)
    A_q: Any  # (LEVELS + 2 or 1, n_q, n_q)
    A_v: Any
    A_f: Any
    A_g: Any
    W: Any


@by_address
class Motion(NamedTuple):
    """What steps change of a `theta.State`: the same arrays, few enough to hand from function to function."""

    q: Any
    v: Any
    g: Any
    u: Any
    p: Any
    closed: Any
    force: Any
    impulse: Any
    v_free: Any
    restitution: Any  # that the kernels of the steps see


@by_address
class Saved(NamedTuple):
    """What a step and its parts begin with."""

    vec: Any  # (9, n_q)
    num: Any  # (5, n_c)
    closed: Any  # (n_c,)
    impulse: Any
    count: Any
    done: Any  # (5,)
    times: Any  # (n,) states asked for
    switches: Any  # `adaptive_switches.Switches`


def run(
    model: Any,
    levels: Any,
    state: Any,
    motion: Any,
    record: Any,
    count: Any,
    control: Any,
    saved: Any,
    c: Any,
) -> int:
    """Steps until the end of the span, full buffers, or a step that cannot be taken; says why it returned."""
    while control.whole[TRIED] < control.whole[UNTIL]:
        if over(control):
            return FINISHED
        if len(record.rows) - count[ROW] < len(saved.times) - count[NEXT_TIME] + 4:
            return PAUSED
        level = control.whole[LEVEL]
        if levels.ready[level] == 0 or levels.ready[level + 1] == 0:
            return WANTED
        control.whole[TRIED] += 1
        code = attempt(model, levels, state, motion, record, count, control, saved, c)
        full, done = code == LOG_FULL and saved.count[EVENT] > 0, saved.done
        verdict = AGAIN
        if not full:
            verdict = judge(
                control,
                code != FINISHED,
                done[APART_Q],
                done[APART_V],
                motion.q,
                motion.v,
                done[HAPPENED] > 0.0,
                np.inf,
            )
        if verdict != ACCEPTED:
            restore(motion, count, saved)
        done[UNDER_WAY] = 0.0
        if full:
            return PAUSED
        if verdict == GIVEN_UP:
            return TOO_SMALL if code == FINISHED else code
    return PAUSED


@inline
def attempt(
    model: Any,
    levels: Any,
    state: Any,
    motion: Any,
    record: Any,
    count: Any,
    control: Any,
    saved: Any,
    c: Any,
) -> int:
    """One step, then two halves of it; the errors in saved.done. The halves are left out where they cannot help."""
    store(motion, count, saved)
    done, slow = saved.done, resolved(control, SIZE_V)
    begin(saved.switches, motion.closed, motion.u, slow)
    t, h = now(control), step_size(control, control.whole[LEVEL])
    for part in range(3):
        if part == 1:
            share = max(1.0, h / (control.real[SPAN] * LEAST_SHARE))
            most_q, most_v = share * resolved(control, SIZE_Q), share * slow
            if 0.5 * done[APART_Q] > most_q or 0.5 * done[APART_V] > most_v:
                done[APART_Q] = np.inf
                return FINISHED
            for i in range(len(motion.q)):
                saved.vec[ONE_Q, i], saved.vec[ONE_V, i] = motion.q[i], motion.v[i]
            restore(motion, count, saved)
            done[APART_Q] = done[APART_V] = 0.0
        before(motion, saved, slow)
        halves = 1 if part > 0 else 0
        plan = plan_of(levels, control.whole[LEVEL] + halves, h * 0.5**halves)
        start, k, rows, events = (t + plan.h if part == 2 else t), count[STEP], count[ROW], count[EVENT]
        if c is None:
            code = run_contacts(model, plan, state, record, count, start, k, k + 1, False, False)
        else:
            code = run_constrained(model, plan, state, record, count, start, k, k + 1, c)
        if code != FINISHED:
            return code
        after(motion, saved, plan.h, slow)
        note(saved.switches, part, plan.h, plan, state, saved.num[PART_RATE], slow, c)
        end = start + plan.h
        if part == 2 and end != goal(control):
            stamp(record, rows, count[ROW], events, count[EVENT], end, goal(control))
            end = goal(control)
        if part > 0:
            keep_times(levels.theta, motion, record.rows, count, saved, start, end)
    if count[EVENT] > saved.count[EVENT]:
        done[HAPPENED] = 1.0
    done[APART_Q] = max(done[APART_Q], distance(saved.vec[ONE_Q], motion.q))
    if done[STRUCK] == 0.0:
        done[APART_V] = max(done[APART_V], distance(saved.vec[ONE_V], motion.v))
        done[APART_V] = max(done[APART_V], unseen(saved.switches, h, levels.theta == 0.5))
    return FINISHED


@inline
def plan_of(levels: Any, level: int, h: float) -> Any:
    """What a step of a level multiplies with."""
    k = level if levels.constant else 0
    return Plan(
        h, levels.theta, levels.A_q[k], levels.A_v[k], levels.A_f[k], levels.A_g[k], levels.W[k], levels.slack
    )


@inline
def before(motion: Any, saved: Any, slow: float) -> None:
    """Remember where a part begins; contacts slower than `slow` have no restitution in it."""
    for i in range(len(motion.q)):
        saved.vec[PART_Q, i], saved.vec[PART_V, i] = motion.q[i], motion.v[i]
    for i in range(len(motion.u)):
        saved.num[PART_GAP, i], saved.num[PART_RATE, i], motion.p[i] = motion.g[i], motion.u[i], 0.0
        motion.restitution[i] = saved.num[RESTITUTION, i] if abs(motion.u[i]) > slow else 0.0


@inline
def after(motion: Any, saved: Any, h: float, slow: float) -> None:
    """Errors of a part at its contacts."""
    done, deeper, struck = saved.done, 0.0, False
    for i in range(len(motion.u)):
        gained = max(0.0, -motion.g[i]) - max(0.0, -saved.num[PART_GAP, i])
        if motion.p[i] > 0.0:
            struck = struck or abs(motion.u[i] - saved.num[PART_RATE, i]) > slow
        else:
            gained = max(gained, dip(saved.num[PART_GAP, i], saved.num[PART_RATE, i], motion.u[i], h))
            if gained > 0.0:
                done[HAPPENED] = 1.0
        deeper = max(deeper, gained)
    done[APART_Q] = max(done[APART_Q], deeper)
    if struck:
        done[HAPPENED] = done[STRUCK] = 1.0
        done[APART_Q] = max(done[APART_Q], h * distance(motion.v, saved.vec[PART_V]))
        done[APART_V] = max(done[APART_V], distance(motion.v_free, saved.vec[PART_V]))


@inline
def dip(g: float, u: float, u_next: float, h: float) -> float:
    """How deep a gap that closes first and then opens has been below zero in between."""
    if not u < 0.0 < u_next:
        return 0.0
    return max(0.0, 0.5 * h * u * u / (u_next - u) - max(0.0, g))


@inline
def keep_times(theta: float, motion: Any, rows: Any, count: Any, saved: Any, t: float, t_next: float) -> None:
    """Keep the states asked for within a part: velocities linear, positions as `between` would have them."""
    h, bend = t_next - t, bending(theta)
    while count[NEXT_TIME] < len(saved.times) and saved.times[count[NEXT_TIME]] <= t_next + LATE * h:
        s = min(1.0, (saved.times[count[NEXT_TIME]] - t) / h)
        for i in range(len(motion.q)):
            q, v = saved.vec[PART_Q, i], saved.vec[PART_V, i]
            curve = 0.5 * bend * h * (motion.v[i] - v)
            saved.vec[BETWEEN_Q, i] = q + s * (motion.q[i] - q) - s * (1.0 - s) * curve
            saved.vec[BETWEEN_V, i] = v + s * (motion.v[i] - v)
        row = rows[count[ROW]]
        write_row(
            row,
            saved.times[count[NEXT_TIME]],
            0.0,
            saved.vec[BETWEEN_Q],
            saved.vec[BETWEEN_V],
            motion.impulse,
        )
        count[ROW] += 1
        count[NEXT_TIME] += 1


def bending(theta: float) -> float:
    """1 where positions follow the integral of the velocity to second order, so that steps are long; else 0."""
    return 1.0 if theta == 0.5 else 0.0


@inline
def store(motion: Any, count: Any, saved: Any) -> None:
    """Keep the state at the start of a step."""
    for i in range(len(motion.q)):
        saved.vec[Q, i], saved.vec[V, i], saved.vec[FORCE, i] = motion.q[i], motion.v[i], motion.force[i]
    for i in range(len(motion.u)):
        saved.num[GAP, i], saved.num[RATE, i], saved.closed[i] = motion.g[i], motion.u[i], motion.closed[i]
    for i in range(len(motion.impulse)):
        saved.impulse[i] = motion.impulse[i]
    for i in range(len(count)):
        saved.count[i] = count[i]
    for i in range(UNDER_WAY):
        saved.done[i] = 0.0
    saved.done[UNDER_WAY] = 1.0


def restore(motion: Any, count: Any, saved: Any) -> None:
    """Go back there; work that was done stays counted, and whether anything happened known."""
    if count[EVENT] > saved.count[EVENT]:
        saved.done[HAPPENED] = 1.0
    saved.count[LCP_CALLS], saved.count[FORCES] = count[LCP_CALLS], count[FORCES]
    for i in range(len(motion.q)):
        motion.q[i], motion.v[i], motion.force[i] = saved.vec[Q, i], saved.vec[V, i], saved.vec[FORCE, i]
    for i in range(len(motion.u)):
        motion.g[i], motion.u[i], motion.closed[i] = saved.num[GAP, i], saved.num[RATE, i], saved.closed[i]
    for i in range(len(motion.impulse)):
        motion.impulse[i] = saved.impulse[i]
    for i in range(len(count)):
        count[i] = saved.count[i]


class Attempts:
    """A run of `Moreau` as `adaptive.advance` wants it."""

    def __init__(
        self, plan: Callable[[float], Plan], model: Model, state: State, record: Record, count: Any, control: Control,
        constraints: Constraints | None, fast: bool,
    ) -> None:  # fmt: skip
        self.plan, self.count, self.control, control.real[SIZE_Q] = plan, count, control, largest(state.q)
        control.real[SIZE_V] = largest(state.v)
        first = plan(step_size(control, 0))
        self.levels = room(first, model.linear)
        self.saved = Saved(
            vec=np.zeros((BETWEEN_V + 1, len(state.q))), num=np.zeros((RESTITUTION + 1, len(state.u))),
            closed=state.closed.copy(), impulse=state.impulse.copy(), count=count.copy(),
            done=np.zeros(UNDER_WAY + 1), times=record.times, switches=switches(len(state.u), constraints),
        )  # fmt: skip
        self.saved.num[RESTITUTION] = model.restitution
        own = model._replace(restitution=model.restitution.copy())
        plain = record._replace(times=np.zeros(0))
        self.motion = Motion(
            state.q, state.v, state.g, state.u, state.p, state.closed, state.force, state.impulse, state.v_free,
            own.restitution,
        )  # fmt: skip
        self.arguments = own, self.levels, state, self.motion, plain, count, control, self.saved, constraints
        never: tuple[Callable[..., Any], ...] = (run_contacts,)
        if constraints is None:
            never = (run_constrained, linearise) if model.linear else (run_constrained,)
        self.kernel = compiled(run, never) if fast else run

    def attempts(self) -> int:
        """Take steps until the loop returns."""
        code = WANTED
        while code == WANTED:
            for level in (int(self.control.whole[LEVEL]), int(self.control.whole[LEVEL]) + 1):
                self.prepare(level, step_size(self.control, level))
            code = int(self.kernel(*self.arguments))
        return code

    def prepare(self, level: int, h: float) -> None:
        """Matrices of a level."""
        if self.levels.constant and not self.levels.ready[level]:
            made = self.plan(h)
            for name in MATRICES:
                getattr(self.levels, name)[level] = getattr(made, name)
        self.levels.ready[level] = 1

    def undo(self) -> None:
        """Back to the start of a step that was interrupted."""
        if self.saved.done[UNDER_WAY]:
            restore(self.motion, self.count, self.saved)


def room(first: Plan, constant: bool) -> Levels:
    """For the matrices of all levels; memory is taken for those that are used."""
    n = LEVELS + 2
    arrays = {name: np.zeros((n if constant else 1, *getattr(first, name).shape)) for name in MATRICES}
    return Levels(first.theta, first.slack, constant, np.zeros(n, dtype=np.int64), **arrays)


def switches(n_c: int, constraints: Constraints | None) -> Switches:
    """For the rows of all contacts."""
    rows = n_c + (0 if constraints is None else len(constraints.T_t))
    return Switches(
        force=np.zeros((3, rows)), impulse=np.zeros((3, rows)), holds=np.zeros((3, rows), dtype=np.int64),
        held=np.zeros(rows, dtype=np.int64), mobility=np.zeros(rows), response=np.zeros(rows), turned=np.zeros(rows),
    )  # fmt: skip
