"""The loop of `Located`, as kernels: steps, and within each step the impacts at their own times.

A step is a chain of pieces of smooth motion (`smooth`). A piece ends where the first gap closes, at a corner of
the scene, or with the step; there the impulses are found (`impulses`), and the next piece begins with the
velocities after them. Gaps of contacts that have just fired count from zero, so a chain of ever shorter hops is
followed without loss of digits.
"""

from __future__ import annotations

from typing import Any

from lcpstep.compiled import inline
from lcpstep.dense import assign
from lcpstep.dynamics import external_force, moves, obstacle, product
from lcpstep.recording import quiet_until
from lcpstep.stepping.corners import at_corner, find_corners, obstacles_move
from lcpstep.stepping.located_event import event
from lcpstep.stepping.located_glide import glide
from lcpstep.stepping.located_joints import (
    joints_failed,
    turn_with_joints,
)
from lcpstep.stepping.located_keep import just_after, keep, keep_times
from lcpstep.stepping.located_piece import begin_piece, first_contact, move, polish
from lcpstep.stepping.located_work import (
    ALPHA,
    BLIND,
    BUFFER_FULL,
    CLOSE_HITS,
    CLOSED,
    CLOSED_NOW,
    CORNER,
    END,
    END_S,
    EPS,
    EVENT,
    EVENTS,
    EVENTS_LEFT,
    FINISHED,
    FORCE,
    FORCES,
    FREE,
    GAP,
    GAP_T,
    GOAL,
    GROUND,
    GROUNDED,
    HALF,
    HIGH,
    HITS,
    IDLE,
    LAST,
    LCP_FAILED,
    LOW,
    NEXT_FORCE,
    NEXT_TIME,
    NOBODY,
    NOT_FINITE,
    OPEN,
    PAUSING,
    Q_TIME,
    RATE,
    ROW,
    SETTLED,
    SIGMA,
    STALLED,
    STATUS,
    STEP,
    STOPPED,
    SWING,
    TOO_MANY_EVENTS,
    TURNED,
    UNDER_WAY,
    V_STRUCK,
    WHOLE,
    Q,
    V,
)
from lcpstep.stepping.magnitudes import acceleration_terms
from lcpstep.stepping.race import race
from lcpstep.stepping.settle import endless, settle
from lcpstep.stepping.smooth import (
    free_acceleration,
    measure,
    respond,
    within,
)
from lcpstep.stepping.switches import idle


def begin(m: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t: float) -> int:
    """Forces, gaps and status of the initial state, which is kept where states are."""
    x[LOW], x[HIGH] = find_corners(plan, t)
    if plan.trapezoidal:
        external_force(m, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FORCE])
    elif not free_acceleration(m, w, within(plan, x, t), w.vec[Q], w.vec[V], w.vec[FREE]):
        return NOT_FINITE
    count[FORCES] += 1
    if plan.steady:
        for i in range(w.vec.shape[1]):
            w.vec[FREE, i] = product(plan.A_inverse[WHOLE], w.vec[FORCE], i)
    measure(m, plan, w, x, t)
    if plan.constant:
        respond(m, w)
        for c in range(w.num.shape[1]):
            w.num[ALPHA, c] = product(m.G, w.vec[FREE], c)
    for c in range(w.num.shape[1]):
        if w.num[GAP, c] <= plan.slack:
            w.num[GAP, c], w.mark[GROUNDED, c] = 0.0, GROUND
            size = abs(w.num[GAP_T, c]) + plan.h * acceleration_terms(m, w, c)
            for i in range(w.vec.shape[1]):
                size += abs(w.G[c, i] * w.vec[V, i])
            if abs(w.num[RATE, c]) <= 64 * EPS * size:
                w.num[RATE, c], w.mark[STATUS, c] = 0.0, CLOSED
                x[CLOSED_NOW] += 1
    if len(record.times) == 0:
        keep(w, record, count, t, 0.0)
    elif record.times[0] == t:
        keep(w, record, count, t, 0.0)
        count[NEXT_TIME] = 1
    return FINISHED


def run(
    model: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t0: float, first: int, last: int
) -> int:
    """Steps count[STEP] .. last - 1, step `first` beginning at t0; says why it returned."""
    n_c = w.num.shape[1]
    single = plan.trapezoidal and model.flat and n_c <= 1 and w.vec.shape[1] == 1
    while count[STEP] < last:
        if x[UNDER_WAY] == 0.0:
            if single and (n_c == 0 or w.mark[STATUS, 0] == OPEN):
                end = quiet_until(record, count[STEP], count[NEXT_TIME], plan.h, t0, first, last)
                glide(model, plan, w, x, count, t0, first, end)
                if count[STEP] >= last:
                    return FINISHED
            begin_step(w, x)
        t = t0 + plan.h * (count[STEP] - first)
        code = step(model, plan, w, x, record, count, t)
        if code != FINISHED:
            return code
        t_next = x[GOAL] if x[PAUSING] == 1.0 else t0 + plan.h * (count[STEP] + 1 - first)
        late = just_after(plan, t_next)
        keep_times(model, plan, w, x, record, count, late, late)
        count[STEP] += 1
        x[UNDER_WAY] = 0.0
        if not finite(w):
            return NOT_FINITE
        code = joints_failed(w)
        if code != FINISHED:
            return code
        if record.every > 0 and count[STEP] % record.every == 0:
            keep(w, record, count, t_next, 0.0)
    return FINISHED


@inline
def begin_step(w: Any, x: Any) -> None:
    """Nothing has happened in this step yet, but for what happened at the very end of the last one."""
    end = x[SIGMA]
    if x[EVENTS] > 0.0:
        x[SETTLED] = x[STALLED] = 0.0
        for i in range(w.vec.shape[1]):
            w.vec[SWING, i] = 0.0
    x[SIGMA] = x[EVENTS] = x[END] = 0.0
    x[UNDER_WAY] = 1.0
    for c in range(w.num.shape[1]):
        w.mark[HITS, c] = w.mark[CLOSE_HITS, c] = 0
        w.num[LAST, c] = 0.0 if end > 0.0 and w.num[LAST, c] == end else -1.0
        w.num[TURNED, c] -= end


@inline
def step(model: Any, plan: Any, w: Any, x: Any, record: Any, count: Any, t: float) -> int:
    """The rest of the step that began at t: from x[SIGMA] to its end."""
    n_c = w.num.shape[1]
    while True:
        if count[EVENT] + 4 * n_c + 4 > len(record.events) or count[ROW] + 4 > len(record.rows):
            return BUFFER_FULL
        if count[EVENT] + count[IDLE] > count[EVENTS_LEFT]:
            return TOO_MANY_EVENTS
        c = NOBODY
        if x[SIGMA] >= x[END]:
            if x[END] >= plan.h:
                return FINISHED
            c = CORNER if begin_interval(model, plan, w, x, count, t) else NOBODY
        if c == NOBODY:
            if not begin_piece(model, plan, w, x, record, t + x[SIGMA], count):
                return LCP_FAILED if finite(w) else NOT_FINITE
            if endless(plan, x):
                code = settle(model, plan, w, x, record, t, count)
                if code != FINISHED:
                    return code
                continue
            rest = x[END] - x[SIGMA]
            tau = rest
            if x[BLIND] > 0.0:
                tau = min(rest, x[BLIND])
            else:
                c, tau = first_contact(plan, w, rest, t + x[END])
                if c != NOBODY and not plan.plain:
                    c, tau = polish(model, plan, w, c, t + x[SIGMA], tau, rest)
                if c != NOBODY and plan.plain and plan.steady and racing(w, x, record, count, t):
                    most = min(count[EVENTS_LEFT] - count[EVENT], plan.per_step - int(x[EVENTS])) + 1
                    most = min(
                        most, len(record.events) - count[EVENT] - 4 * n_c, len(record.rows) - count[ROW] - 4
                    )
                    done = race(model, plan, w, record, count, t, x[SIGMA], x[END], most)
                    if done > 0:
                        x[SIGMA] = w.vec[Q_TIME, 0]
                        x[EVENTS] += done
                        continue
                if c != NOBODY and at_corner(plan, x, t + x[SIGMA] + tau):
                    c, tau = NOBODY, rest
                if c == NOBODY and tau < rest:
                    idle(x, count)
            code = move(model, plan, w, x, record, t, tau, c == NOBODY and tau == rest, count)
            if code == FINISHED and x[BLIND] > 0.0:
                code = STOPPED
            if code != FINISHED:
                return code
        if c != NOBODY:
            code = struck(model, plan, w, x, record, t, c, count)
            if code != FINISHED:
                return code


def struck(m: Any, plan: Any, w: Any, x: Any, record: Any, t: float, c: int, count: Any) -> int:
    """The impact of a contact or of a corner; STOPPED where steps by a tolerance want to look at it."""
    pausing = x[PAUSING] == 1.0 and c != CORNER
    if pausing:
        assign(w.vec[V_STRUCK], w.vec[V])
    code = event(m, plan, w, x, record, t, c, count)
    return STOPPED if pausing and code == FINISHED else code


def racing(w: Any, x: Any, record: Any, count: Any, t: float) -> bool:
    """Whether impacts of several bodies in free flight may be taken in turn, no state being asked for meanwhile."""
    wanted = count[NEXT_TIME] < len(record.times) and record.times[count[NEXT_TIME]] <= t + x[END]
    return w.num.shape[1] > 1 and x[CLOSED_NOW] == 0 and not wanted


def begin_interval(m: Any, plan: Any, w: Any, x: Any, count: Any, t: float) -> bool:
    """The smooth interval from x[SIGMA] to the next corner or the end of the step; forces at its ends.

    Whether it begins at a corner at which velocities of gaps may jump.
    """
    now, turns = t + x[SIGMA], False
    if now >= x[HIGH] - plan.margin:
        x[LOW], x[HIGH] = find_corners(plan, now)
        turns = obstacles_move(m) or plan.joined
        if plan.trapezoidal and not plan.steady:
            external_force(m, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FORCE])
        elif not plan.trapezoidal:
            turn_with_joints(w, within(plan, x, now))
            free_acceleration(m, w, within(plan, x, now), w.vec[Q], w.vec[V], w.vec[FREE])
        count[FORCES] += 1
    x[END] = plan.h
    if t + plan.h > x[HIGH] + plan.margin:
        x[END] = max(x[HIGH] - t, x[SIGMA])
    end = within(plan, x, t + x[END])
    if plan.trapezoidal and not plan.steady:
        external_force(m, end, w.vec[Q], w.vec[V], w.vec[NEXT_FORCE])
        count[FORCES] += 1
    if m.flat and moves(m):
        obstacle(m, end, w.vec[Q], w.vec[V])
        for c in range(w.num.shape[1]):
            w.num[END_S, c] = m.motion_now[c, 2]
    return turns


@inline
def finite(w: Any) -> bool:
    """Whether state and gaps are finite, and their accelerations in the last piece."""
    total = 0.0
    for i in range(w.vec.shape[1]):
        total += (w.vec[Q, i] - w.vec[Q, i]) + (w.vec[V, i] - w.vec[V, i])
    for c in range(w.num.shape[1]):
        total += (w.num[GAP, c] - w.num[GAP, c]) + (w.num[RATE, c] - w.num[RATE, c])
        total += w.num[HALF, c] - w.num[HALF, c]
    return total == 0.0
