"""A Runge-Kutta step of several contacts and joints, up to the first event within it, as kernels."""

from __future__ import annotations

import math
from typing import Any

from lcpstep.dense import assign, split
from lcpstep.events.bookkeeping import (
    FINISHED,
    FORCES,
    NEXT_TIME,
    NOT_FINITE,
    STEP,
    STEP_TOO_SMALL,
    is_due,
    is_wanted,
)
from lcpstep.events.clock import HIGH, RESOLUTION, T0, after
from lcpstep.events.contact import hop
from lcpstep.events.dop853 import (
    EXTRA_STAGES,
    LEAST,
    STAGES,
    combine,
    dense_error,
    error_norm,
    factor,
    interpolant,
    refuse,
    repeats,
)
from lcpstep.events.several.earliest import MEETS, NONE, OPENS, first_event, observe, remember
from lcpstep.events.several.equations import measure, measure_on
from lcpstep.events.several.forces import DONE, contact_forces
from lcpstep.events.several.held import constrain, hold_again, note, parted, project, right_hand_side
from lcpstep.events.several.keep import keep, keep_wanted, store_dense
from lcpstep.events.several.motion import lift, press_between, rebase
from lcpstep.events.several.state import (
    ACCELERATION,
    CLOSED,
    CULPRIT,
    CURVE,
    FOUND,
    FREE_ACCELERATION,
    GAP,
    HELD,
    HELD_ROWS,
    JOINTS_DISAGREE,
    JUMP,
    LEFT_GAP,
    LENGTH,
    NEXT,
    NEXT_STEP,
    NO_FORCES,
    OBEY,
    Q0,
    SEEN,
    SETTLE,
    SPEED,
    V0,
    Q,
    V,
)

PARTS = 4  # scan intervals of a step
REFINEMENTS = 3  # of an event's time by repeated steps
LOOK_AHEAD = 1e-6  # of a step: where the forces after a release are looked at


def step(s: Any, count: Any) -> int:
    """One DOP853 step, and the first event within it; `complete` takes it over."""
    remember(s)
    longest = min(s.plan.t_end, s.x[HIGH]) - s.x[T0]
    h = take_step(s, count, min(longest, s.plan.scan, 4.0 * shortest_hop(s)))
    if h < 0.0:
        return int(-h)
    tau, a = NONE, 0.0
    for part in range(1, PARTS + 1):
        if tau == NONE and len(s.G) > 0:
            b = h * part / PARTS
            if not observe(s, b):
                return NOT_FINITE
            tau = first_event(s, a, b)
            for i in range(len(s.G)):
                for k in range(4):
                    s.contact[LEFT_GAP + k, i] = s.seen[k, i]
            a = b
    s.x[FOUND], s.x[SEEN] = tau, a
    return FINISHED


def complete(s: Any, record: Any, count: Any) -> int:
    """Take over the step that has just been made, which ends early if an event was found in it."""
    border, h, tau, end = min(s.plan.t_end, s.x[HIGH]), s.x[LENGTH], s.x[FOUND], s.x[SEEN]
    if tau == NONE:
        t_next = border if h >= border - s.x[T0] else after(s.x, h)
        take_over(s, record, count, t_next, h)
        return pass_end(s, record, count)
    c, kind = int(s.seen[4, 0]), int(s.seen[4, 1])
    if kind == OPENS and not look_ahead(s, c, tau, end):
        return NO_FORCES
    if tau > 0.0:
        tau = shorten(s, c, tau, kind)
    take_over(s, record, count, min(after(s.x, tau), border), tau)
    if not measure_on(s, s.x[T0]):
        return NOT_FINITE
    if kind == OPENS:
        s.number[NEXT] = OBEY
        return FINISHED
    s.number[NEXT] = JUMP
    lift(s, c)
    if kind != MEETS:
        s.contact[SPEED, c], s.mode[CLOSED, c], s.contact[HELD, c] = 0.0, 1, s.x[T0] + end
    return FINISHED


def shortest_hop(s: Any) -> float:
    """Duration of the shortest hop that has just begun, were its acceleration constant."""
    shortest = math.inf
    for c in range(len(s.G)):
        u, alpha = s.contact[SPEED, c], s.contact[CURVE, c]
        if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0 and u > 0.0 and alpha < 0.0:
            shortest = min(shortest, hop(u, alpha))
    return shortest


def take_step(s: Any, count: Any, longest: float) -> float:
    """DOP853 step no longer than `longest` that meets the tolerance; its size, or minus the reason of failure."""
    w, t = s.w, s.x[T0]
    h = min(s.x[NEXT_STEP], longest)
    truncated, again = h < s.x[NEXT_STEP], False
    while True:
        good = stages(s, h)
        count[FORCES] += STAGES + 1
        if good and again and not repeats(w, h, s.plan.rtol, s.plan.atol):
            return -float(STEP_TOO_SMALL)
        error = error_norm(w, h, s.plan.rtol, s.plan.atol) if good else math.inf
        if error <= 1.0:
            if not dense_stages(s, h):
                return -float(NOT_FINITE)
            count[FORCES] += EXTRA_STAGES
            error = max(error, dense_error(w, h, s.plan.rtol, s.plan.atol))
        if error <= 1.0:
            break
        # rows held may become dependent, or a force infinite, beyond what a shorter step reaches
        h *= max(LEAST, factor(error)) if math.isfinite(error) else LEAST
        truncated, again = False, good
        if not refuse(w, t, s.plan.scan) or h <= 4.0 * RESOLUTION * max(abs(t), s.plan.scan):
            return -float(STEP_TOO_SMALL if good and math.isfinite(error) else NOT_FINITE)
    s.x[NEXT_STEP] = max(h * factor(error), s.x[NEXT_STEP] if truncated else 0.0)
    return h


def stages(s: Any, h: float) -> bool:
    """DOP853 step of size h from w.y to w.y_new; False where it is not finite."""
    w, t = s.w, s.x[T0]
    if not right_hand_side(s, t, w.y, w.K[0]):
        return False
    for stage in range(1, STAGES):
        combine(w, h, stage)
        if not right_hand_side(s, t + w.tab.C[stage] * h, w.y_stage, w.K[stage]):
            return False
    combine(w, h, STAGES)
    assign(w.y_new, w.y_stage)
    return right_hand_side(s, t + h, w.y_new, w.K[STAGES])


def dense_stages(s: Any, h: float) -> bool:
    """Dense output of the step that `stages` has just made."""
    w, t = s.w, s.x[T0]
    for stage in range(STAGES + 1, STAGES + 1 + EXTRA_STAGES):
        combine(w, h, stage)
        if not right_hand_side(s, t + w.tab.C[stage] * h, w.y_stage, w.K[stage]):
            return False
    interpolant(w, h)
    s.x[LENGTH] = h
    return True


def shorten(s: Any, c: int, tau: float, kind: int) -> float:
    """Repeat the step up to the event, corrected so that its own end, and not the dense output, meets the surface.

    The last repetition is not corrected any more: what is returned is the length of the step whose end is the state.
    """
    stages(s, tau)
    for _ in range(REFINEMENTS if kind == MEETS else 0):
        dense_stages(s, tau)
        observe(s, tau)
        g, u = s.contact[GAP, c], s.contact[SPEED, c]
        correction = -g / u if u < 0.0 else 0.0
        if abs(correction) <= 2.0 * RESOLUTION * (abs(s.x[T0]) + tau) or abs(correction) > 1e-3 * tau:
            break
        tau += correction
        stages(s, tau)
    dense_stages(s, tau)
    return tau


def look_ahead(s: Any, c: int, tau: float, end: float) -> bool:
    """Which contacts are closed, and carry a force, just after the multiplier of contact c has turned negative."""
    ahead = tau + LOOK_AHEAD * s.x[LENGTH]
    observe(s, ahead)
    t, before = s.x[T0] + ahead, s.number[HELD_ROWS]
    for m in range(before):  # the rows held are needed for the rest of the interval
        s.kept[m] = s.row[m]
    if not measure(s, t):
        return False
    solved = contact_forces(s, t) == DONE
    if s.mode[CLOSED, c] == 1:
        s.contact[HELD, c] = s.x[T0] + end
    for m in range(before):
        s.row[m] = s.kept[m]
    s.number[HELD_ROWS] = before
    return solved


def take_over(s: Any, record: Any, count: Any, t: float, tau: float) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    count[STEP] += 1
    pressed = 0.0
    while is_wanted(record, count, t, t >= s.plan.t_end):
        wanted = record.times[count[NEXT_TIME]] - s.x[T0]
        press_between(s, pressed, wanted)
        pressed = wanted
        keep_wanted(s, record, count)
    if tau > 0.0:
        press_between(s, pressed, tau)
        store_dense(s, record, count)
        split(s.w.y_new, s.state[Q], s.state[V])
        if s.number[HELD_ROWS] > 0:
            project(s, t)
    else:
        assign(s.state[Q], s.state[Q0])
        assign(s.state[V], s.state[V0])
    rebase(s, t)


def pass_end(s: Any, record: Any, count: Any) -> int:
    """Go on beyond the end of a step without an event, with the same rows held."""
    if not measure_on(s, s.x[T0]):
        return NOT_FINITE
    s.number[CULPRIT] = parted(s)
    if s.number[CULPRIT] >= 0:
        return JOINTS_DISAGREE
    a = s.state[ACCELERATION]
    assign(a, s.state[FREE_ACCELERATION])
    if s.number[HELD_ROWS] > 0:
        if not hold_again(s, s.x[T0], s.state[Q], s.state[V]):
            s.number[NEXT] = SETTLE
            return FINISHED
        constrain(s, a)
    note(s, a)
    if is_due(record, count):
        keep(s, record, count, s.x[T0])
    return FINISHED
