"""The event-driven loop for several contacts and joints, as kernels.

Between events the closed contacts and the joints are held on acceleration level; an event is a contact that closes
(an impact, of all contacts closed at that time) or a multiplier that turns negative (a release, after which the
contact forces are sought anew). The motion is a DOP853 step, or exact where the acceleration is constant. See
`equations`, `impact` and `earliest` for the three parts.

Chattering ends where what is left out is below the tolerance: hops under a pressing acceleration are no higher than
it, or impacts of contacts that nothing presses (inelastic collapse) have both a speed and a way below it. Source:
A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems with complete chattering,
Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address
from lcpstep.dense import assign, join, split
from lcpstep.dynamics import product
from lcpstep.events.dop853 import (
    EXTRA_STAGES,
    LEAST,
    STAGES,
    combine,
    error_norm,
    factor,
    interpolant,
    interpolate,
)
from lcpstep.events.earliest import (
    MEETS,
    NONE,
    OPENS,
    first_event,
    first_root,
    observe,
    remember,
)
from lcpstep.events.equations import (
    ACCELERATION,
    CHATTERS,
    CLOSED,
    CULPRIT,
    CURVE,
    FREE_ACCELERATION,
    GAP,
    HELD,
    HELD_ROWS,
    IMPULSE,
    LCP_Z,
    LEFT_GAP,
    LEFT_SPEED,
    MEMBERS,
    MULTIPLIER,
    NEXT,
    NOISE,
    Q0,
    RESOLUTION,
    SINCE,
    SPEED,
    STRUCK,
    V0,
    WAS_CLOSED,
    Q,
    V,
    bias_of,
    biases,
    constrain,
    constraint_rows,
    hold_again,
    hold_contacts,
    measure,
    parted,
    project,
    right_hand_side,
    solve_held,
)
from lcpstep.events.flow import HIGH, LENGTH, REST, T0, T0_REST, after
from lcpstep.events.flow import N_NUMBERS as N_PIECE
from lcpstep.events.impact import (
    CONTRADICTION,
    DONE,
    apply,
    contact_forces,
    note,
    speed_noise,
    strike,
    synchronise,
)
from lcpstep.events.integrator import (
    ACCUMULATION,
    IMPACT,
    MAX_STALLED,
    PARTS,
    REFINEMENTS,
    RELEASE,
    STICK,
    find_corners,
)
from lcpstep.events.run import (
    BUFFER_FULL,
    EVENT,
    EVENTS,
    FINISHED,
    FORCES,
    NEXT_TIME,
    NOT_FINITE,
    ROW,
    STALLED,
    STEP,
    STEP_TOO_SMALL,
    TOO_MANY_EVENTS,
)
from lcpstep.recording import LEAD, write_event
from lcpstep.recording import LENGTH as STEP_LENGTH
from lcpstep.recording import TIME as ROW_TIME

# Why the loop returned, beside the reasons of `integrator`
NO_IMPULSES, NO_FORCES, JOINTS_DISAGREE = range(10, 13)
# Numbers of Several.x after those of a piece
# BARE: 1 while the acceleration is that without contacts; FOUND: event in the step at hand, looked for up to SEEN
NEXT_STEP, LAST_EVENT, BARE, FOUND, SEEN = range(N_PIECE, N_PIECE + 5)
N_NUMBERS = N_PIECE + 5
MOVE, JUMP, SETTLE, OBEY = range(4)  # what comes next
LOOK_AHEAD = 1e-6  # of a step: where the forces after a release are looked at
START = 64 * RESOLUTION  # an initial gap this small, relative to the state, is closed
ROUNDS = 1000  # problems of impacts at one instant


@by_address
class Plan(NamedTuple):
    """How the smooth motion is computed, and to what tolerance."""

    constant: bool  # the acceleration is constant between events, and gaps are linear in q
    scan: float  # longest Runge-Kutta step
    nodes: Any  # of the quadrature of constraint forces, on [0, 1]
    weights: Any
    rtol: float
    atol: float
    corners: Any  # (m,) in [0, period)
    period: float
    t_end: float
    max_events: int


@by_address
class Tools(NamedTuple):
    """Runge-Kutta coefficients and stages, and the solver of complementarity problems."""

    tab: Any
    w: Any
    dy: Any  # (2 n_q,)
    seen: Any  # (5, n_c), n_c >= 2
    lcp: Any
    solver: Any


def run(model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any, goal: int) -> int:
    """Go on from x[T0] to the end of the span, or to step number `goal`; says why it returned."""
    code = FINISHED
    if count[ROW] == 0 and count[STEP] == 0 and s.number[NEXT] == MOVE:
        find_corners(plan, s, s.x[T0])
        s.number[NEXT] = JUMP
        if not measure(model, joints, s, s.x[T0]):
            return NOT_FINITE
        for c in range(len(s.G)):
            s.contact[GAP, c] = (
                0.0 if s.contact[GAP, c] <= START * scale(s.state[Q], 1.0) else s.contact[GAP, c]
            )
    # What follows what is said here, and not where it is called: numba optimises callees anew in every caller.
    while code == FINISHED and (s.number[NEXT] != MOVE or (s.x[T0] < plan.t_end and count[STEP] < goal)):
        if s.number[NEXT] == JUMP:
            s.number[NEXT] = SETTLE
            code = jump(model, plan, s, tools, record, count)
        elif s.number[NEXT] == SETTLE:
            s.number[NEXT] = MOVE
            code = settle(model, joints, plan, s, tools, record, count)
        elif s.number[NEXT] == OBEY:
            s.number[NEXT] = MOVE
            obey(model, s, record, count)
        elif count[ROW] == 0 and len(record.times) == 0:
            keep(s, record, count, s.x[T0])
        elif 2 * count[EVENT] > len(record.events) or count[ROW] + 4 > len(record.rows):
            code = BUFFER_FULL
        elif count[EVENTS] > plan.max_events or count[STALLED] > MAX_STALLED:
            code = TOO_MANY_EVENTS
        elif s.x[T0] >= s.x[HIGH]:
            find_corners(plan, s, s.x[T0])
            s.number[NEXT] = SETTLE
        elif plan.constant:
            fly(plan, s, tools, record, count)
        else:
            code = step(model, joints, plan, s, tools, count)
            if code == FINISHED:
                code = complete(model, joints, plan, s, tools, record, count)
    return code


# --- smooth motion --------------------------------------------------------------------------------------------


def fly(plan: Any, s: Any, tools: Any, record: Any, count: Any) -> None:
    """Constant acceleration up to the next contact, or to the end of the span."""
    n_c, border = len(s.G), plan.t_end - s.x[T0]
    tau, meets = border, -1
    for c in range(n_c):
        if s.mode[CLOSED, c] == 0:
            root = first_root(s.contact[GAP, c], s.contact[SPEED, c], s.contact[CURVE, c])
            if root < tau:
                tau, meets = root, c
    t = plan.t_end if meets < 0 else min(after(s, tau), plan.t_end)
    count[STEP] += 1
    s.x[LENGTH] = tau
    pressed = 0.0
    while is_wanted(record, count, t, meets < 0):
        wanted = record.times[count[NEXT_TIME]] - s.x[T0]
        press(s, wanted - pressed)
        pressed = wanted
        keep_wanted(plan, s, tools, record, count)
    press(s, tau - pressed)
    state_at(plan, s, tools, tau)
    store_dense(plan, s, tools, record, count)
    for c in range(n_c):
        if s.mode[CLOSED, c] == 0:
            u, alpha = s.contact[SPEED, c], s.contact[CURVE, c]
            s.contact[GAP, c] = max(0.0, s.contact[GAP, c] + tau * (u + 0.5 * alpha * tau))
            s.contact[SPEED, c] = u + alpha * tau
    rebase(plan, s, tools, t)
    if meets < 0:
        if record.every > 0 and count[STEP] % record.every == 0:
            keep(s, record, count, t)
        return
    s.contact[GAP, meets] = 0.0
    s.number[NEXT] = JUMP


def step(model: Any, joints: Any, plan: Any, s: Any, tools: Any, count: Any) -> int:
    """One DOP853 step, and the first event within it; `complete` takes it over."""
    remember(s)
    longest = min(plan.t_end, s.x[HIGH]) - s.x[T0]
    h = take_step(model, joints, plan, s, tools, count, min(longest, plan.scan, 4.0 * shortest_hop(s)))
    if h < 0.0:
        return int(-h)
    tau, a = NONE, 0.0
    w, dy, seen = tools.w, tools.dy, tools.seen
    for part in range(1, PARTS + 1):
        if tau == NONE and len(s.G) > 0:
            b = h * part / PARTS
            if not observe(model, joints, s, w, dy, b):
                return NOT_FINITE
            tau = first_event(model, joints, s, w, dy, a, b, seen)
            for i in range(len(s.G)):
                for k in range(4):
                    s.contact[LEFT_GAP + k, i] = seen[k, i]
            a = b
    s.x[FOUND], s.x[SEEN] = tau, a
    return FINISHED


def complete(model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any) -> int:
    """Take over the step that has just been made, which ends early if an event was found in it."""
    border, h, tau, end = min(plan.t_end, s.x[HIGH]), s.x[LENGTH], s.x[FOUND], s.x[SEEN]
    if tau == NONE:
        t_next = border if h >= border - s.x[T0] else after(s, h)
        take_over(model, joints, plan, s, tools, record, count, t_next, h)
        return pass_end(model, joints, plan, s, tools, record, count)
    c, kind = int(tools.seen[4, 0]), int(tools.seen[4, 1])
    if kind == OPENS and not look_ahead(model, joints, plan, s, tools, c, tau, end):
        return NO_FORCES
    if tau > 0.0:
        tau = shorten(model, joints, s, tools, c, tau, kind)
    take_over(model, joints, plan, s, tools, record, count, min(after(s, tau), border), tau)
    if not measure_on(model, joints, s, s.x[T0]):
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
            shortest = min(shortest, 2.0 * u / -alpha)
    return shortest


def take_step(model: Any, joints: Any, plan: Any, s: Any, tools: Any, count: Any, longest: float) -> float:
    """DOP853 step no longer than `longest` that meets the tolerance; its size, or minus the reason of failure."""
    w, t = tools.w, s.x[T0]
    h = min(s.x[NEXT_STEP], longest)
    truncated = h < s.x[NEXT_STEP]
    while True:
        good = stages(model, joints, s, tools, h)
        count[FORCES] += STAGES + 1
        error = error_norm(tools.tab, w, h, plan.rtol, plan.atol) if good else math.inf
        if error <= 1.0:
            break
        # rows held may become dependent, or a force infinite, beyond what a shorter step reaches
        h *= max(LEAST, factor(error)) if math.isfinite(error) else LEAST
        truncated = False
        if h <= 4.0 * RESOLUTION * max(abs(t), plan.scan):
            return -float(STEP_TOO_SMALL if good and math.isfinite(error) else NOT_FINITE)
    s.x[NEXT_STEP] = max(h * factor(error), s.x[NEXT_STEP] if truncated else 0.0)
    if not dense_stages(model, joints, s, tools, h):
        return -float(NOT_FINITE)
    count[FORCES] += EXTRA_STAGES
    return h


def stages(model: Any, joints: Any, s: Any, tools: Any, h: float) -> bool:
    """DOP853 step of size h from w.y to w.y_new; False where it is not finite."""
    w, tab, t = tools.w, tools.tab, s.x[T0]
    if not right_hand_side(model, joints, s, t, w.y, w.K[0]):
        return False
    for stage in range(1, STAGES):
        combine(tab, w, h, stage)
        if not right_hand_side(model, joints, s, t + tab.C[stage] * h, w.y_stage, w.K[stage]):
            return False
    combine(tab, w, h, STAGES)
    assign(w.y_new, w.y_stage)
    return right_hand_side(model, joints, s, t + h, w.y_new, w.K[STAGES])


def dense_stages(model: Any, joints: Any, s: Any, tools: Any, h: float) -> bool:
    """Dense output of the step that `stages` has just made."""
    w, tab, t = tools.w, tools.tab, s.x[T0]
    for stage in range(STAGES + 1, STAGES + 1 + EXTRA_STAGES):
        combine(tab, w, h, stage)
        if not right_hand_side(model, joints, s, t + tab.C[stage] * h, w.y_stage, w.K[stage]):
            return False
    interpolant(tab, w, h)
    s.x[LENGTH] = h
    return True


def shorten(model: Any, joints: Any, s: Any, tools: Any, c: int, tau: float, kind: int) -> float:
    """Repeat the step up to the event, corrected so that its own end, and not the dense output, meets the surface."""
    for _ in range(REFINEMENTS):
        stages(model, joints, s, tools, tau)
        dense_stages(model, joints, s, tools, tau)
        if kind != MEETS:
            break
        observe(model, joints, s, tools.w, tools.dy, tau)
        g, u = s.contact[GAP, c], s.contact[SPEED, c]
        correction = -g / u if u < 0.0 else 0.0
        if abs(correction) <= 2.0 * RESOLUTION * (abs(s.x[T0]) + tau) or abs(correction) > 1e-3 * tau:
            break
        tau += correction
    return tau


def look_ahead(
    model: Any, joints: Any, plan: Any, s: Any, tools: Any, c: int, tau: float, end: float
) -> bool:
    """Which contacts are closed, and carry a force, just after the multiplier of contact c has turned negative."""
    ahead = tau + LOOK_AHEAD * s.x[LENGTH]
    observe(model, joints, s, tools.w, tools.dy, ahead)
    t, before = s.x[T0] + ahead, s.number[HELD_ROWS]
    for m in range(before):  # the rows held are needed for the rest of the interval
        s.kept[m] = s.row[m]
    if not measure(model, joints, s, t):
        return False
    solved = contact_forces(model, s, tools.lcp, tools.solver, t) == DONE
    if s.mode[CLOSED, c] == 1:
        s.contact[HELD, c] = s.x[T0] + end
    for m in range(before):
        s.row[m] = s.kept[m]
    s.number[HELD_ROWS] = before
    return solved


def take_over(
    model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any, t: float, tau: float
) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    count[STEP] += 1
    pressed = 0.0
    while is_wanted(record, count, t, t >= plan.t_end):
        wanted = record.times[count[NEXT_TIME]] - s.x[T0]
        press_between(model, joints, plan, s, tools, pressed, wanted)
        pressed = wanted
        keep_wanted(plan, s, tools, record, count)
    if tau > 0.0:
        press_between(model, joints, plan, s, tools, pressed, tau)
        store_dense(plan, s, tools, record, count)
        split(tools.w.y_new, s.state[Q], s.state[V])
        if s.number[HELD_ROWS] > 0:
            project(model, joints, s, t)
    else:
        assign(s.state[Q], s.state[Q0])
        assign(s.state[V], s.state[V0])
    rebase(plan, s, tools, t)


def press(s: Any, tau: float) -> None:
    """Add the impulses of the forces over the time tau."""
    for c in range(len(s.G)):
        s.contact[IMPULSE, c] += s.contact[MULTIPLIER, c] * tau
    for i in range(len(s.J)):
        s.joint[IMPULSE, i] += s.joint[MULTIPLIER, i] * tau


def press_between(model: Any, joints: Any, plan: Any, s: Any, tools: Any, a: float, b: float) -> None:
    """The same for forces that change between a and b after the base: Gauss' quadrature."""
    if s.number[HELD_ROWS] == 0 or b <= a:
        return
    for k in range(len(plan.nodes)):
        observe(model, joints, s, tools.w, tools.dy, a + plan.nodes[k] * (b - a))
        press(s, plan.weights[k] * (b - a))


def pass_end(model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any) -> int:
    """Go on beyond the end of a step without an event, with the same rows held."""
    if not measure_on(model, joints, s, s.x[T0]):
        return NOT_FINITE
    s.number[CULPRIT] = parted(s, plan.rtol, plan.atol)
    if s.number[CULPRIT] >= 0:
        return JOINTS_DISAGREE
    a = s.state[ACCELERATION]
    assign(a, s.state[FREE_ACCELERATION])
    if s.number[HELD_ROWS] > 0:
        if not hold_again(model, joints, s, s.x[T0], s.state[Q], s.state[V]):
            s.number[NEXT] = SETTLE
            return FINISHED
        constrain(model, s, a)
    note(s, a)
    if record.every > 0 and count[STEP] % record.every == 0:
        keep(s, record, count, s.x[T0])
    return FINISHED


def measure_on(model: Any, joints: Any, s: Any, t: float) -> bool:
    """`measure`, with the gaps and speeds of closed contacts exactly zero."""
    if not measure(model, joints, s, t):
        return False
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 1:
            s.contact[GAP, c] = s.contact[SPEED, c] = 0.0
    return True


def rebase(plan: Any, s: Any, tools: Any, t: float) -> None:
    """Begin a new piece at time t with the state Q, V."""
    assign(s.state[Q0], s.state[Q])
    assign(s.state[V0], s.state[V])
    if not plan.constant:
        join(tools.w.y, s.state[Q], s.state[V])
    s.x[T0] = t
    s.x[T0_REST], s.x[REST] = s.x[REST], 0.0


def state_at(plan: Any, s: Any, tools: Any, tau: float) -> None:
    """Q, V at the time tau after the base."""
    if plan.constant:
        a = s.state[ACCELERATION]
        for j in range(len(a)):
            s.state[Q, j] = s.state[Q0, j] + tau * (s.state[V0, j] + 0.5 * tau * a[j])
            s.state[V, j] = s.state[V0, j] + tau * a[j]
    elif tau == 0.0:
        assign(s.state[Q], s.state[Q0])
        assign(s.state[V], s.state[V0])
    else:
        interpolate(tools.w.F, tools.w.y, tau / s.x[LENGTH], tools.w.y_stage)
        split(tools.w.y_stage, s.state[Q], s.state[V])


# --- events ---------------------------------------------------------------------------------------------------


def jump(model: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any) -> int:
    """Impacts at the state Q, V until no contact that is closed approaches.

    A contact without speed to rounding, on the surface to rounding, is closed.
    """
    n_c, t = len(s.G), s.x[T0]
    tolerance = touching(plan, s)
    for turn in range(ROUNDS):
        noise, hit = speed_noise(s), False
        for c in range(n_c):
            g, u = s.contact[GAP, c], s.contact[SPEED, c]
            if s.mode[CLOSED, c] == 0 and g <= tolerance and u <= noise:
                if not plan.constant:
                    lift(s, c)
                s.contact[GAP, c] = 0.0
                if u >= -noise:
                    s.mode[CLOSED, c], s.contact[SPEED, c] = 1, 0.0
                hit = hit or u < -noise
            s.contact[LEFT_SPEED, c] = s.contact[SPEED, c]
        if not hit:
            return FINISHED
        if count[EVENT] + 4 * n_c + 4 > len(record.events) or turn == ROUNDS - 1:
            return TOO_MANY_EVENTS
        if strike(model, s, tools.lcp, tools.solver, plan.constant) != DONE:
            return NO_IMPULSES
        tell_impacts(model, s, record, count, t)
        if plan.constant:
            synchronise(model, s)
    return TOO_MANY_EVENTS


def touching(plan: Any, s: Any) -> float:
    """Gaps that are closed: zero where they are followed exactly, else below the tolerance."""
    return 0.0 if plan.constant else plan.atol + plan.rtol * scale(s.state[Q], 1.0)


def scale(x: Any, least: float) -> float:
    """Largest entry of x, or `least`."""
    for j in range(len(x)):
        least = max(least, abs(x[j]))
    return least


def lift(s: Any, c: int) -> None:
    """Put Q onto the surface of contact c, which it misses by no more than the tolerance: hops start from there."""
    i = len(s.J) + c
    for j in range(s.state.shape[1]):
        s.state[Q, j] -= s.MR[i, j] * s.contact[GAP, c] / s.D[i, i]
    s.contact[GAP, c] = 0.0


def tell_impacts(model: Any, s: Any, record: Any, count: Any, t: float) -> None:
    """Log the impacts of the problem just solved; contacts that it leaves without speed are closed."""
    noise = speed_noise(s)
    for m in range(s.number[MEMBERS]):
        c, p = s.member[m], s.contact[LCP_Z, m]
        before = s.contact[LEFT_SPEED, c]
        if p > 0.0:
            u = -model.restitution[c] * before
            log(record, s, count, t, c, float(IMPACT), before, u, p)
            s.contact[SINCE, c], s.contact[STRUCK, c] = t - s.contact[STRUCK, c], t
        else:
            u = s.contact[SPEED, c]
        s.mode[CLOSED, c] = 0 if u > noise else 1
        s.contact[SPEED, c] = u if u > noise else 0.0
        s.contact[GAP, c] = 0.0


def settle(model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any) -> int:
    """After a jump: contact forces, contacts that open, chattering that is over."""
    n_c, t = len(s.G), s.x[T0]
    for _ in range(n_c + 1):
        if not plan.constant and not measure_again(model, joints, s, t):
            return NOT_FINITE
        code = forces(model, plan, s, tools, t)
        if code != FINISHED:
            return code
        if not close_chatter(model, joints, plan, s, tools, record, count):
            break
    if tell_modes(s, record, count, t) and plan.constant:
        polish(model, joints, s)
    rebase(plan, s, tools, t)
    keep_event(s, record, count, t)
    return FINISHED


def forces(model: Any, plan: Any, s: Any, tools: Any, t: float) -> int:
    """Accelerations and multipliers; nothing to do where no contact is or was closed under constant acceleration."""
    closed = 0
    for c in range(len(s.G)):
        closed += s.mode[CLOSED, c]
    if plan.constant and closed == 0 and s.x[BARE] == 1.0:
        return FINISHED
    code = contact_forces(model, s, tools.lcp, tools.solver, t)
    if code != DONE:
        return JOINTS_DISAGREE if code == CONTRADICTION else NO_FORCES
    s.x[BARE] = 1.0 if closed == 0 else 0.0
    return FINISHED


def obey(model: Any, s: Any, record: Any, count: Any) -> None:
    """After a release: the contacts closed and loaded are those that `look_ahead` has found."""
    a, t = s.state[ACCELERATION], s.x[T0]
    assign(a, s.state[FREE_ACCELERATION])
    hold_contacts(s)
    constrain(model, s, a)
    note(s, a)
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] == 0 and s.mode[WAS_CLOSED, c] == 1:
            s.contact[GAP, c] = s.contact[SPEED, c] = 0.0
            s.contact[CURVE, c] = max(s.contact[CURVE, c], 0.0)
    tell_modes(s, record, count, t)
    keep_event(s, record, count, t)


def measure_again(model: Any, joints: Any, s: Any, t: float) -> bool:
    """`measure`, keeping the gaps and speeds that are known better."""
    for c in range(len(s.G)):
        s.contact[LEFT_GAP, c], s.contact[LEFT_SPEED, c] = s.contact[GAP, c], s.contact[SPEED, c]
    if not measure(model, joints, s, t):
        return False
    for c in range(len(s.G)):
        s.contact[GAP, c], s.contact[SPEED, c] = s.contact[LEFT_GAP, c], s.contact[LEFT_SPEED, c]
    return True


def close_chatter(model: Any, joints: Any, plan: Any, s: Any, tools: Any, record: Any, count: Any) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    n_c, n_j, t, some = len(s.G), len(s.J), s.x[T0], False
    for c in range(n_c):
        if s.mode[CLOSED, c] == 0 and s.contact[GAP, c] == 0.0 and s.contact[STRUCK, c] == t:
            T = chatter_left(model, joints, plan, s, tools, c)
            if T >= 0.0:
                u, alpha = s.contact[SPEED, c], s.contact[CURVE, c]
                log(
                    record,
                    s,
                    count,
                    t + T,
                    c,
                    float(ACCUMULATION),
                    -u,
                    0.0,
                    max(-alpha * T - u, 0.0) / s.D[n_j + c, n_j + c],
                )
                s.mode[CLOSED, c], s.contact[CHATTERS, c], some = 1, t + T, True
    if some:
        hold_contacts(s)
        for m in range(s.number[HELD_ROWS]):
            i = s.row[m]
            s.change[m] = 0.0 if i < n_j else -s.contact[SPEED, i - n_j]
        solve_held(s, s.number[HELD_ROWS], s.change)
        apply(s, plan.constant)
        for c in range(n_c):
            if s.mode[CLOSED, c] == 1:
                s.contact[SPEED, c] = 0.0
    return some


def polish(model: Any, joints: Any, s: Any) -> None:
    """Take from Q, V what rounding has left of the gaps and speeds that are zero."""
    k, n_j = s.number[HELD_ROWS], len(s.J)
    for x in (Q, Q, V, V):
        for m in range(k):
            i = s.row[m]
            s.change[m] = -product(s.R, s.state[x], i)
            if x == Q:
                s.change[m] -= joints.offset[i] if i < n_j else model.offset[i - n_j]
        solve_held(s, k, s.change)
        for m in range(k):
            for j in range(s.state.shape[1]):
                s.state[x, j] += s.MR[s.row[m], j] * s.change[m]


def chatter_left(model: Any, joints: Any, plan: Any, s: Any, tools: Any, c: int) -> float:
    """How long the impacts of contact c that are left out would last, or -1 if they may not be.

    Pressed by alpha < 0 they accumulate after 2 u / (|alpha| (1 - r)), no hop being higher than u^2 / (2 |alpha|).
    """
    u, alpha, r = s.contact[SPEED, c], s.contact[CURVE, c], model.restitution[c]
    if r == 1.0:
        return -1.0
    speed = scale(s.state[V], 0.0)
    tolerance = plan.atol + plan.rtol * scale(s.state[Q], 0.0)
    if alpha == 0.0 or abs(alpha) * s.contact[SINCE, c] <= NOISE * (u + speed):  # an inelastic collapse
        slow = u <= plan.atol + plan.rtol * speed and u * s.contact[SINCE, c] <= tolerance
        return 0.0 if slow else -1.0
    if alpha > 0.0 or u * u > -2.0 * alpha * tolerance:
        return -1.0
    T = 2.0 * u / (-alpha * (1.0 - r))
    if s.x[T0] + T > min(s.x[HIGH], plan.t_end):
        return -1.0
    for d in range(len(s.G)):  # nothing else may happen meanwhile
        g, u_d, alpha_d = s.contact[GAP, d], s.contact[SPEED, d], s.contact[CURVE, d]
        if s.mode[CLOSED, d] == 0 and g > 0.0 and first_root(g, u_d, alpha_d) < T:
            return -1.0
    if plan.constant:
        return T
    change = later(model, joints, s, tools, c, T) - alpha
    return T if abs(change) * T * max(speed, 1.0) <= -alpha * tolerance else -1.0


def later(model: Any, joints: Any, s: Any, tools: Any, c: int, T: float) -> float:
    """Gap acceleration of contact c at the time T from now, along the tangent of the motion."""
    y, n = tools.w.y_stage, s.state.shape[1]
    for j in range(n):
        y[j] = s.state[Q, j] + T * s.state[V, j]
        y[n + j] = s.state[V, j] + T * s.state[ACCELERATION, j]
    curve = math.nan
    if right_hand_side(model, joints, s, s.x[T0] + T, y, tools.dy):
        biases(model, s, s.G, s.contact, s.x[T0] + T, y[:n], y[n:])
        constraint_rows(model, joints, s, s.x[T0] + T, y[:n], y[n:])
        curve = product(s.R, tools.dy[n:], len(s.J) + c) + bias_of(s, len(s.J) + c)
    measure_again(model, joints, s, s.x[T0])
    return curve


def tell_modes(s: Any, record: Any, count: Any, t: float) -> bool:
    """Log the contacts that have opened, and those that have closed for good; whether there is one of these."""
    some = False
    for c in range(len(s.G)):
        if s.mode[CLOSED, c] != s.mode[WAS_CLOSED, c]:
            kind = STICK if s.mode[CLOSED, c] == 1 else RELEASE
            some = some or kind == STICK
            when = max(t, s.contact[CHATTERS, c]) if kind == STICK else t
            log(record, s, count, when, c, float(kind), 0.0, s.contact[SPEED, c], 0.0)
            s.mode[WAS_CLOSED, c] = s.mode[CLOSED, c]
    return some


# --- what is kept ---------------------------------------------------------------------------------------------


def log(
    record: Any, s: Any, count: Any, t: float, c: int, kind: float, before: float, after_: float, p: float
) -> None:
    """Note an event; those that pass without the time going on are counted."""
    write_event(record.events[count[EVENT]], t, c, before, after_, p, int(kind))
    stalled = abs(s.x[T0] - s.x[LAST_EVENT]) <= 4.0 * RESOLUTION * abs(s.x[T0])
    count[STALLED] = count[STALLED] + 1 if stalled else 0
    s.x[LAST_EVENT] = s.x[T0]
    count[EVENT] += 1
    count[EVENTS] += 1


def is_wanted(record: Any, count: Any, stop: float, last: bool) -> bool:
    """Whether a state is asked for before the time `stop` (or at it, at the end of the span)."""
    if count[NEXT_TIME] >= len(record.times) or count[ROW] >= len(record.rows):
        return False
    t = record.times[count[NEXT_TIME]]
    return bool(t < stop or (t == stop and last))


def keep_wanted(plan: Any, s: Any, tools: Any, record: Any, count: Any) -> None:
    """Keep the state that is asked for next."""
    t = record.times[count[NEXT_TIME]]
    state_at(plan, s, tools, t - s.x[T0])
    keep(s, record, count, t)
    count[NEXT_TIME] += 1


def keep_event(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not record.on_events and record.every != 1:
        return
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == t:
        count[ROW] -= 1
        row, n = record.rows[count[ROW]], LEAD + 2 * s.state.shape[1]
        for c in range(len(s.G)):
            s.contact[IMPULSE, c] += row[n + c]
        for i in range(len(s.J)):
            s.joint[IMPULSE, i] += row[n + len(s.G) + i]
    keep(s, record, count, t)


def keep(s: Any, record: Any, count: Any, t: float) -> None:
    """Keep the state Q, V at time t, and the impulses of contacts and joints since the one before."""
    row, n = record.rows[count[ROW]], s.state.shape[1]
    row[ROW_TIME] = t
    for j in range(n):
        row[LEAD + j], row[LEAD + n + j] = s.state[Q, j], s.state[V, j]
    for c in range(len(s.G)):
        row[LEAD + 2 * n + c], s.contact[IMPULSE, c] = s.contact[IMPULSE, c], 0.0
    for i in range(len(s.J)):
        row[LEAD + 2 * n + len(s.G) + i], s.joint[IMPULSE, i] = s.joint[IMPULSE, i], 0.0
    count[ROW] += 1


def store_dense(plan: Any, s: Any, tools: Any, record: Any, count: Any) -> None:
    """Keep the motion from the last kept state on: the dense output of the step, or the acceleration."""
    if len(record.dense) > 0:
        if plan.constant:
            assign(record.dense[count[ROW] - 1], s.state[ACCELERATION])
        else:
            assign(record.dense[count[ROW] - 1], tools.w.F)
        record.rows[count[ROW] - 1, STEP_LENGTH] = s.x[LENGTH]
