"""The event-driven loop, as kernels: smooth pieces, and what happens where they meet.

Modes of the contact, with the gap velocity u and the gap acceleration alpha of the free motion:

    free      g > 0, or g = 0 and u > 0, or g = u = 0 and alpha > 0
    impact    g = 0, u < 0                     -> u+ = -r u-
    closed    g = u = 0, alpha <= 0            -> the contact force keeps g = 0 until alpha turns positive

A chattering sequence is carried to its accumulation point 2 u+ / (|alpha| (1 - r)) after the impact once the error
of doing so is below the tolerance. Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.16 and 4.2;
A. Nordmark, P. Piiroinen, Simulation and stability analysis of impacting systems with complete chattering,
Nonlinear Dynamics 58 (2009).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from lcpstep.compiled import by_address
from lcpstep.dense import assign, join
from lcpstep.dynamics import gap_rates, gaps, product
from lcpstep.events.dop853 import EXTRA_STAGES, LEAST, STAGES, error_norm, factor
from lcpstep.events.flow import (
    ALPHA0,
    CLOSED,
    FREE,
    HIGH,
    LENGTH,
    LOW,
    MODE,
    NUDGE,
    ON_SURFACE,
    REST,
    SCALE,
    SPEED0,
    T0,
    T0_REST,
    after,
    contact_at,
    contact_response,
    free_acceleration,
    gap_acceleration,
    gap_bias,
    inside,
    near_surface,
    rk_dense,
    rk_step,
    state_at,
)
from lcpstep.events.locate import NONE, first_contact, first_release, short_hop
from lcpstep.events.run import (
    BUFFER_FULL,
    EVENT,
    EVENTS,
    FINISHED,
    FORCES,
    NEVER_LEFT,
    NEXT_TIME,
    NOT_FINITE,
    ROW,
    SLACK,
    STALLED,
    STEP,
    STEP_TOO_SMALL,
    TOO_MANY_EVENTS,
)
from lcpstep.recording import LEAD, write_event, write_row
from lcpstep.recording import LENGTH as STEP_LENGTH
from lcpstep.recording import TIME as ROW_TIME

# Places in the array of the loop's numbers
NOW, NEXT_STEP, EDGE_G, EDGE_U, EDGE_ALPHA, IMPULSE = range(6)
FROM, TO, END, FOUND, HOP = range(6, 11)  # the interval at hand, after the base; its end; an event within it
LAST_EVENT, HOLD = 11, 12  # HOLD: no release before this time
RESOLVED = 13  # longest step on which the gap has been found smooth, allowed to grow again
N_NUMBERS = 14
# Kinds of events, the values of `trajectory.Kind`
IMPACT, ACCUMULATION, STICK, RELEASE = range(4)

RESOLUTION = 2.0**-52
JUST_RELEASED = 1e-300  # a gap acceleration that is zero, on its way up
TOO_LONG = -1  # an interval that is to be repeated with a shorter step
GROWTH = 1.25  # of the longest step from one step to the next
PARTS = 4  # scan intervals of a Runge-Kutta step
ON_THE_SURFACE = 64 * RESOLUTION  # a gap this small, relative to the state, is closed
LONGER = 3.0  # how much longer than its guess a short hop may last
MAX_STALLED = 1000  # events at one time
ROUGH = 0.1  # share of its change by which the gap velocity may differ from the trapezoidal rule's
SMALLEST = 2.0**-20  # of the scan interval: what is still rough then is a jump that nobody has named
REFINEMENTS = 4  # of an event's time by repeated Runge-Kutta steps


@by_address
class Flow(NamedTuple):
    """How the smooth motion is computed, and to what tolerance."""

    contact: bool  # whether the scene has a contact
    scan: float  # longest interval of the scan for events
    nodes: Any  # of the quadrature of contact forces, on [0, 1]
    weights: Any
    rtol: float
    atol: float
    corners: Any  # (m,) in [0, period)
    period: float
    t_end: float
    max_events: int


def begin(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, t: float) -> bool:
    """The state at the start of the span, which may lie on the surface or strike it at once."""
    x[NOW] = t
    find_corners(flow, piece, t)
    rebase(model, flow, piece, w, t)
    if flow.contact:
        g, u, alpha = contact_at(model, flow, piece, w, 0.0)
        if g - g + u - u + alpha - alpha != 0.0:
            return False
        length = speed = 1.0
        for i in range(len(piece.q)):
            length, speed = max(length, abs(piece.q[i])), max(speed, abs(piece.v[i]))
        x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = g, u, alpha
        if g <= ON_THE_SURFACE * length:
            if u < -ON_THE_SURFACE * speed:
                impact(model, flow, piece, w, record, count, x, u)
            else:
                settle(model, flow, piece, w, record, count, x, u if u > ON_THE_SURFACE * speed else 0.0)
    if count[ROW] == 0 and len(record.times) == 0:
        assign(piece.q, piece.q0)
        assign(piece.v, piece.v0)
        keep(piece, record, count, x, t)
    return True


def run(
    model: Any, flow: Any, piece: Any, tab: Any, w: Any, record: Any, count: Any, x: Any, goal: int
) -> int:
    """Go on from x[NOW] to the end of the span, or to step number `goal`; says why it returned."""
    if count[ROW] == 0 and count[STEP] == 0 and not begin(model, flow, piece, w, record, count, x, x[NOW]):
        return NOT_FINITE
    while x[NOW] < flow.t_end and count[STEP] < goal:
        if count[EVENT] + SLACK > len(record.events) or count[ROW] + SLACK > len(record.rows):
            return BUFFER_FULL
        if count[EVENTS] > flow.max_events or count[STALLED] > MAX_STALLED:
            return TOO_MANY_EVENTS
        if x[NOW] >= piece.x[HIGH]:
            turn_corner(model, flow, piece, w, x)
        if piece.x[MODE] == CLOSED and x[EDGE_ALPHA] > 0.0:
            release(model, flow, piece, w, record, count, x, x[EDGE_ALPHA])
            keep_event(piece, record, count, x)
        code = runge_kutta_interval(model, flow, piece, tab, w, count, x)
        if code == FINISHED:
            code = finish_interval(model, flow, piece, tab, w, record, count, x)
        elif code == TOO_LONG:
            code = FINISHED
        elif code == NEVER_LEFT:
            settle_again(model, flow, piece, w, record, count, x)
            code = FINISHED
        if code != FINISHED:
            return code
    return FINISHED


# --- one interval ---------------------------------------------------------------------------------------------


def runge_kutta_interval(model: Any, flow: Any, piece: Any, tab: Any, w: Any, count: Any, x: Any) -> int:
    """One DOP853 step, up to the first event within it."""
    border = min(flow.t_end, piece.x[HIGH])
    if x[HOLD] > x[NOW]:
        border = min(border, x[HOLD])
    longest = border - x[NOW]
    x[END] = min(border, x[NOW] + x[NEXT_STEP])
    guess = hop_time(piece, x)
    h = take_step(model, flow, piece, tab, w, count, x, min(longest, x[RESOLVED], 4.0 * guess))
    if h < 0.0:
        return int(-h)
    x[RESOLVED] = min(flow.scan, GROWTH * max(x[RESOLVED], h))
    end = after(piece, h) if h < longest else border
    tau, hop = NONE, False
    if flow.contact and piece.x[MODE] == FREE:
        if guess < h:
            tau = short_hop(model, flow, piece, w, guess, min(LONGER * guess, h))
            hop = tau != NONE
        a, at_a = 0.0, (x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA])
        for part in range(1, PARTS + 1):
            if tau == NONE:
                b = h * part / PARTS
                at_b = contact_at(model, flow, piece, w, b)
                if at_b[0] - at_b[0] != 0.0:
                    return NOT_FINITE
                if rough(flow, b - a, at_a, at_b) and h > SMALLEST * flow.scan:
                    x[RESOLVED] = 0.5 * h
                    return TOO_LONG
                tau = first_contact(model, flow, piece, w, a, at_a, b, at_b)
                if tau == NONE and at_a[0] <= 0.0 and at_b[0] < 0.0:
                    x[HOLD] = x[NOW] + b
                    return NEVER_LEFT
                a, at_a = b, at_b
        if tau == NONE:
            x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = at_a
        elif not hop:
            tau = refine_contact(model, flow, piece, tab, w, tau)
    x[FROM], x[TO], x[END], x[FOUND], x[HOP] = 0.0, h, end, tau, 1.0 if hop else 0.0
    return FINISHED


def rough(
    flow: Any, length: float, at_a: tuple[float, float, float], at_b: tuple[float, float, float]
) -> bool:
    """Whether the gap may do more within an interval than is seen at its ends: gap, velocity, acceleration there.

    The system's own motion bounds the step by the tolerance; a gap can turn faster: a shaken obstacle, a washboard.
    """
    change = at_b[1] - at_a[1] - 0.5 * length * (at_a[2] + at_b[2])
    if change - change != 0.0:
        return False  # what is not finite is another's to find
    unseen = length * abs(change)
    smooth = abs(change) <= ROUGH * 0.5 * length * (abs(at_a[2]) + abs(at_b[2]))
    return not (smooth or unseen <= flow.atol or unseen <= ROUGH * min(at_a[0], at_b[0]))


def hop_time(piece: Any, x: Any) -> float:
    """Duration of the hop that has just begun, were its acceleration constant; infinite if none has."""
    if piece.x[ON_SURFACE] == 1.0 and x[NOW] == piece.x[T0] and x[EDGE_ALPHA] < 0.0 and x[EDGE_U] > 0.0:
        return 2.0 * x[EDGE_U] / -x[EDGE_ALPHA]
    return math.inf


def finish_interval(
    model: Any, flow: Any, piece: Any, tab: Any, w: Any, record: Any, count: Any, x: Any
) -> int:
    """Take over the interval, which ends early if an event was found in it."""
    a, b, end, tau, hop = x[FROM], x[TO], x[END], x[FOUND], x[HOP] == 1.0
    count[STEP] += 1
    closed = flow.contact and piece.x[MODE] == CLOSED
    if closed and x[NOW] >= x[HOLD]:
        tau = first_release(model, flow, piece, w, a, min(x[EDGE_ALPHA], 0.0), b)
    stop = b if tau == NONE else tau
    t_stop = end if tau == NONE else min(after(piece, tau), end)
    if tau != NONE and (closed or hop):
        shorten(model, piece, tab, w, tau)
    if closed:
        x[IMPULSE] += contact_impulse(model, flow, piece, w, a, stop)
    keep_times(model, flow, piece, w, record, count, x, t_stop, tau == NONE and t_stop >= flow.t_end)
    store_dense(piece, w, record, count)
    x[NOW] = t_stop
    if tau == NONE:
        return pass_end(model, flow, piece, w, record, count, x, stop, closed)
    _, u, alpha = contact_at(model, flow, piece, w, stop)
    if alpha - alpha + u - u != 0.0:
        return NOT_FINITE
    if hop:
        _, u = near_surface(model, flow, piece, w, tau)
    state_at(model, flow, piece, w, stop)
    if closed:
        release(model, flow, piece, w, record, count, x, JUST_RELEASED)
        keep_event(piece, record, count, x)
    elif hop or -u > velocity_noise(piece):
        impact(model, flow, piece, w, record, count, x, min(u, 0.0))
    elif stop <= a:  # a touch at the very time of the last event
        x[HOLD] = end
        settle_again(model, flow, piece, w, record, count, x)
    else:  # a touch without impact
        rebase(model, flow, piece, w, t_stop)
        settle(model, flow, piece, w, record, count, x, 0.0)
        keep_event(piece, record, count, x)
    return FINISHED


def velocity_noise(piece: Any) -> float:
    """Rounding of the gap velocity at the state of the piece [m/s]."""
    speed = 1.0
    for i in range(len(piece.v)):
        speed = max(speed, abs(piece.v[i]))
    return ON_THE_SURFACE * speed


def pass_end(
    model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, stop: float, closed: bool
) -> int:
    """Go on beyond the end of an interval without an event."""
    if closed:
        _, u, alpha = contact_at(model, flow, piece, w, stop)
        if alpha - alpha + u - u != 0.0:
            return NOT_FINITE
        x[EDGE_ALPHA] = min(alpha, 0.0)
    state_at(model, flow, piece, w, stop)
    if closed:
        project(model, piece, x[NOW])
    rebase(model, flow, piece, w, x[NOW])
    if record.every > 0 and count[STEP] % record.every == 0:
        keep(piece, record, count, x, x[NOW])
    return FINISHED


# --- Runge-Kutta pieces ---------------------------------------------------------------------------------------


def take_step(
    model: Any, flow: Any, piece: Any, tab: Any, w: Any, count: Any, x: Any, longest: float
) -> float:
    """DOP853 step no longer than `longest` that meets the tolerance; its size, or minus the reason of failure."""
    h = min(x[NEXT_STEP], longest)
    truncated = h < x[NEXT_STEP]
    while True:
        if not rk_step(model, piece, tab, w, x[NOW], h):
            return -float(NOT_FINITE)
        count[FORCES] += STAGES + 1
        error = error_norm(tab, w, h, flow.rtol, flow.atol)
        if error - error != 0.0:
            return -float(NOT_FINITE)
        if error <= 1.0:
            break
        h *= max(LEAST, factor(error))
        truncated = False
        if h <= 4.0 * RESOLUTION * abs(x[NOW]):
            return -float(STEP_TOO_SMALL)
    x[NEXT_STEP] = max(h * factor(error), x[NEXT_STEP] if truncated else 0.0)
    if not rk_dense(model, piece, tab, w, x[NOW], h):
        return -float(NOT_FINITE)
    count[FORCES] += EXTRA_STAGES
    return h


def shorten(model: Any, piece: Any, tab: Any, w: Any, tau: float) -> None:
    """Repeat the step with the size tau, so that its end has the accuracy of a step and not of dense output."""
    rk_step(model, piece, tab, w, piece.x[T0], tau)
    rk_dense(model, piece, tab, w, piece.x[T0], tau)


def refine_contact(model: Any, flow: Any, piece: Any, tab: Any, w: Any, tau: float) -> float:
    """Time of the contact found on the dense output, corrected on steps that end there."""
    for _ in range(REFINEMENTS):
        shorten(model, piece, tab, w, tau)
        g, u, _ = contact_at(model, flow, piece, w, tau)
        correction = -g / u if u < 0.0 else 0.0
        if abs(correction) <= 2.0 * RESOLUTION * (piece.x[T0] + tau) or abs(correction) > 1e-3 * tau:
            break
        tau += correction
    return tau


def project(model: Any, piece: Any, t: float) -> None:
    """Put piece.q, piece.v onto the surface: g = 0, u = 0, against the drift of the integration."""
    for _ in range(2):
        W = contact_response(model, piece, t, piece.q, piece.v)
        gaps(model, t, piece.q, piece.v, piece.g)
        for i in range(len(piece.q)):
            piece.q[i] -= piece.MG[i] * piece.g[0] / W
    W = contact_response(model, piece, t, piece.q, piece.v)
    u = product(piece.G, piece.v, 0) + piece.g_t[0]
    for i in range(len(piece.v)):
        piece.v[i] -= piece.MG[i] * u / W


def rebase(model: Any, flow: Any, piece: Any, w: Any, t: float) -> None:
    """Begin a new piece at time t with the state piece.q, piece.v."""
    assign(piece.q0, piece.q)
    assign(piece.v0, piece.v)
    join(w.y, piece.q, piece.v)
    piece.x[T0], piece.x[ON_SURFACE], piece.x[SPEED0] = t, 0.0, 0.0
    piece.x[T0_REST], piece.x[REST] = piece.x[REST], 0.0


# --- events ---------------------------------------------------------------------------------------------------


def impact(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, u: float) -> None:
    """Newton's law u+ = -r u- at the state piece.q, piece.v; then free flight, chattering or lasting contact."""
    t, r = x[NOW], model.restitution[0]
    W = contact_response(model, piece, t, piece.q, piece.v)
    p = -(1.0 + r) * u / W
    for i in range(len(piece.v)):
        piece.v[i] += piece.MG[i] * p
    x[IMPULSE] += p
    log(record, count, x, t, IMPACT, u, -r * u, p)
    rebase(model, flow, piece, w, t)
    settle(model, flow, piece, w, record, count, x, -r * u)
    keep_event(piece, record, count, x)


def settle(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, u: float) -> None:
    """On the surface at the base of the piece, leaving it with gap velocity u >= 0: which mode comes next."""
    t, r = x[NOW], model.restitution[0]
    find_corners(flow, piece, t)
    piece.x[SPEED0], piece.x[ON_SURFACE], piece.x[MODE] = u, 1.0, FREE
    alpha = gap_acceleration(model, flow, piece, w, 0.0)
    piece.x[ALPHA0] = alpha
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = 0.0, u, alpha
    if alpha > 0.0 or (alpha == 0.0 and u > 0.0):
        return
    if u == 0.0 or 2.0 * u <= -alpha * 4.0 * RESOLUTION * abs(t):
        stick(model, flow, piece, w, record, count, x, t)
    elif chatter_is_over(model, flow, piece, x, u, alpha, r):
        T = 2.0 * u / (-alpha * (1.0 - r))
        W = contact_response(model, piece, t, piece.q0, piece.v0)
        log(record, count, x, t + T, ACCUMULATION, -u, 0.0, (-alpha * T - u) / W)
        x[IMPULSE] -= u / W  # the contact force up to t + T, which counts as closed, gives the rest
        stick(model, flow, piece, w, record, count, x, t + T)


def chatter_is_over(model: Any, flow: Any, piece: Any, x: Any, u: float, alpha: float, r: float) -> bool:
    """Whether taking the remaining impacts as one is within the tolerance.

    They accumulate at T = 2 u / (|alpha| (1-r)) but for T |change of alpha| / |alpha|, and the hops that are
    left out rise no higher than u^2 / (2 |alpha|).
    """
    if r == 1.0:
        return False
    T = 2.0 * u / (-alpha * (1.0 - r))
    if x[NOW] + T > min(piece.x[HIGH], flow.t_end):
        return False
    length, speed = 0.0, 1.0
    for i in range(len(piece.q0)):
        length, speed = max(length, abs(piece.q0[i])), max(speed, abs(piece.v0[i]))
    tolerance = flow.atol + flow.rtol * length
    if u * u / (-2.0 * alpha) > tolerance:
        return False
    # The hops are so low that the state moves along the surface, by its tangent up to O(T^2).
    for i in range(len(piece.q0)):
        piece.q[i], piece.v[i] = piece.q0[i] + T * piece.v0[i], piece.v0[i] + T * piece.a[i]
    later = surface_acceleration(model, piece, x[NOW] + T)
    return later < 0.0 and abs(later - alpha) * T * speed <= -alpha * tolerance


def surface_acceleration(model: Any, piece: Any, t: float) -> float:
    """alpha at the state t, piece.q, piece.v."""
    side = inside(piece, t)
    free_acceleration(model, piece, side, piece.q, piece.v, piece.a)
    gap_rates(model, t, piece.q, piece.v, piece.G, piece.g_t)
    return product(piece.G, piece.a, 0) + gap_bias(model, piece, side, piece.q, piece.v)


def stick(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, t_log: float) -> None:
    """From now on the contact is closed; t_log: when the log says so (the end of a chattering sequence)."""
    piece.x[MODE] = CLOSED
    assign(piece.q, piece.q0)
    assign(piece.v, piece.v0)
    project(model, piece, x[NOW])
    rebase(model, flow, piece, w, x[NOW])
    log(record, count, x, t_log, STICK, 0.0, 0.0, 0.0)


def settle_again(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any) -> None:
    """The contact that seemed to open did so by less than rounding: it is closed, for this interval at least."""
    state_at(model, flow, piece, w, x[NOW] - piece.x[T0])
    rebase(model, flow, piece, w, x[NOW])
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = 0.0, 0.0, -JUST_RELEASED
    stick(model, flow, piece, w, record, count, x, x[NOW])
    keep_event(piece, record, count, x)


def release(model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, alpha: float) -> None:
    """The closed contact opens now, with the gap acceleration alpha."""
    project(model, piece, x[NOW])
    rebase(model, flow, piece, w, x[NOW])
    log(record, count, x, x[NOW], RELEASE, 0.0, 0.0, 0.0)
    piece.x[MODE], piece.x[ON_SURFACE] = FREE, 1.0
    x[EDGE_G], x[EDGE_U], x[EDGE_ALPHA] = 0.0, 0.0, alpha


def turn_corner(model: Any, flow: Any, piece: Any, w: Any, x: Any) -> None:
    """Enter the next smooth interval, with the accelerations of its side."""
    find_corners(flow, piece, x[NOW])
    if flow.contact:
        _, _, x[EDGE_ALPHA] = contact_at(model, flow, piece, w, x[NOW] - piece.x[T0])


def find_corners(flow: Any, piece: Any, t: float) -> None:
    """The smooth interval that begins at t or contains it."""
    piece.x[LOW], piece.x[HIGH] = -math.inf, math.inf
    near = t + 0.5 * NUDGE * max(abs(t), piece.x[SCALE])
    if len(flow.corners) == 0:
        return
    turn = math.floor(near / flow.period) if flow.period < math.inf else 0.0
    for k in range(-1, 2):
        start = (turn + k) * flow.period if flow.period < math.inf else 0.0
        for corner in flow.corners:
            if start + corner <= near:
                piece.x[LOW] = max(piece.x[LOW], start + corner)
            else:
                piece.x[HIGH] = min(piece.x[HIGH], start + corner)


def contact_impulse(model: Any, flow: Any, piece: Any, w: Any, a: float, b: float) -> float:
    """Impulse of the contact force lambda = -alpha / (G M^-1 G^T) over (a, b) of a closed piece [N s]."""
    total = 0.0
    for k in range(len(flow.nodes)):
        tau = a + flow.nodes[k] * (b - a)
        alpha = gap_acceleration(model, flow, piece, w, tau)
        total -= flow.weights[k] * alpha / contact_response(model, piece, piece.x[T0] + tau, piece.q, piece.v)
    return total * (b - a)


# --- what is kept ---------------------------------------------------------------------------------------------


def log(record: Any, count: Any, x: Any, t: float, kind: int, before: float, after: float, p: float) -> None:
    """Note an event."""
    write_event(record.events[count[EVENT]], t, 0, before, after, p, kind)
    count[STALLED] = count[STALLED] + 1 if t == x[LAST_EVENT] else 0
    x[LAST_EVENT] = t
    count[EVENT] += 1
    count[EVENTS] += 1


def keep_times(
    model: Any, flow: Any, piece: Any, w: Any, record: Any, count: Any, x: Any, stop: float, last: bool
) -> None:
    """Keep the states asked for before the time `stop` (and at it, at the end of the span)."""
    while count[NEXT_TIME] < len(record.times) and count[ROW] < len(record.rows):
        t = record.times[count[NEXT_TIME]]
        if t > stop or (t == stop and not last):
            return
        state_at(model, flow, piece, w, t - piece.x[T0])
        keep(piece, record, count, x, t)
        count[NEXT_TIME] += 1


def keep_event(piece: Any, record: Any, count: Any, x: Any) -> None:
    """Keep the state after an event, if these are kept; events at one time share a row."""
    if not record.on_events and record.every != 1:
        return
    assign(piece.q, piece.q0)
    assign(piece.v, piece.v0)
    if count[ROW] > 0 and record.rows[count[ROW] - 1, ROW_TIME] == x[NOW]:
        count[ROW] -= 1
        if record.rows.shape[1] > LEAD + 2 * len(piece.q):
            x[IMPULSE] += record.rows[count[ROW], LEAD + 2 * len(piece.q)]
    keep(piece, record, count, x, x[NOW])


def keep(piece: Any, record: Any, count: Any, x: Any, t: float) -> None:
    """Keep the state piece.q, piece.v at time t, and the impulse since the one before."""
    contacts = record.rows.shape[1] - LEAD - 2 * len(piece.q)
    impulse = x[IMPULSE : IMPULSE + contacts]
    write_row(record.rows[count[ROW]], t, piece.x[MODE], piece.q, piece.v, impulse)
    count[ROW] += 1


def store_dense(piece: Any, w: Any, record: Any, count: Any) -> None:
    """Keep the dense output of the step that began at the last kept state."""
    if len(record.dense) > 0:
        assign(record.dense[count[ROW] - 1], w.F)
        record.rows[count[ROW] - 1, STEP_LENGTH] = piece.x[LENGTH]


def evaluate(model: Any, flow: Any, piece: Any, w: Any, kept: Any, dense: Any, wanted: Any) -> None:
    """States at the times wanted, from the kept states before them and the pieces that start there."""
    for k in range(len(wanted.t)):
        row = wanted.row[k]
        assign(piece.q, kept.q[row])
        assign(piece.v, kept.v[row])
        tau = wanted.t[k] - kept.t[row]
        rebase(model, flow, piece, w, kept.t[row])
        piece.x[MODE] = kept.mode[row]
        if tau > 0.0:
            assign(w.F, dense[row])
            piece.x[LENGTH] = kept.length[row]
            state_at(model, flow, piece, w, tau)
        assign(wanted.q[k], piece.q)
        assign(wanted.v[k], piece.v)


@by_address
class Wanted(NamedTuple):
    """Times asked for, and the states found there."""

    t: Any  # (m,)
    row: Any  # (m,) the kept state at or before each
    q: Any  # (m, n_q)
    v: Any  # (m, n_q)
