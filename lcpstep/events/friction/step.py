"""A Runge-Kutta step of a system with friction, up to the first event within it, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import EDGE, JUMP, LEANS, OBEY, OPEN, SETTLE, STICKS
from lcpstep.kernels.dop853 import ALL, STAGES
from lcpstep.kernels.status import DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, STEP_TOO_SMALL

if not cython.compiled:
    from math import sqrt

    from lcpstep.events.friction.equations import add_impulse, measure
    from lcpstep.events.friction.guards import UNKNOWN, first_event
    from lcpstep.events.friction.held import hold_modes, right_hand_side
    from lcpstep.events.friction.impact import forget_terms, still
    from lcpstep.events.friction.keep import keep
    from lcpstep.events.friction.modes import decide, gives, undecided
    from lcpstep.events.friction.moments import jumps, locate, of_sliding, turns_at_once
    from lcpstep.events.friction.parting import part_before
    from lcpstep.events.friction.state import GUARDS, Rubbing
    from lcpstep.events.friction.surfaces import find_touching, lift
    from lcpstep.events.rows.jumps import breaks
    from lcpstep.events.rows.projection import project
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import clear, copy, product
    from lcpstep.pointers import abs, min

# Of a step: where the forces after a release, or a slip, are looked at, how much further while they are zero, and how
# far at most
LOOK_AHEAD, FURTHER, FARTHEST = 1e-6, 10.0, 1e-2


def step(s: Rubbing, record: Record, tally: Tally) -> int:
    """One step, which ends at the first event within it; what comes next into `next`. A status."""
    t0, border = s.clock.t0, min(s.t_end, s.clock.high)
    s.culprit = -1
    if s.rows.n_held != s.paced:
        change_pace(s)
    code = s.take_step(t0, min(border - t0, s.scan_length), s.scan_length)
    if code != DONE:
        return PAINLEVE_INCONSISTENT if s.culprit >= 0 and code != STEP_TOO_SMALL else code
    h = s.length
    mark_resting(s)
    if breaks(s.rows, s, h, False):
        return DONE
    g = first_event(s, h)
    if g == UNKNOWN:
        return NOT_FINITE
    if g < 0:
        take_over(s, record, tally, border if h >= border - t0 else s.clock.after(h), h)
        if record.is_due(tally.steps):
            keep(s, record, s.clock.t0, s.y)
        return DONE
    if of_force(s, g):
        code = look_ahead(s, h)
        if code != DONE and not (s.yields and code == PAINLEVE_INCONSISTENT):
            return code
    tau = locate(s, g, h, border - t0)
    if tau == UNKNOWN:
        return NOT_FINITE
    if of_sliding(s, g) and turns_at_once(s, g, tau, h):
        return DONE
    take_over(s, record, tally, min(s.clock.after(tau), border), tau)
    if code != DONE or (tau > 0.0 and of_sliding(s, g) and jumps(s, g, tau)):
        return code  # a jump whose polynomial has been there, not the velocity
    return arrive(s, g)


def mark_resting(s: Rubbing) -> None:
    """Which gaps, and which sliding velocities, the modes at hand keep at zero."""
    for c in range(s.n_c):
        i, mode = s.n_j + c, s.mode[c]
        s.rows.rests[i] = 1 if mode != OPEN else 0
        s.rows.rests[i + s.n_c] = 1 if mode in (STICKS, LEANS) else 0


def change_pace(s: Rubbing) -> None:
    """Go on with the step that was next when as many rows were held: what sticks allows others than what slides."""
    s.paces[s.paced] = s.next_step
    if s.paces[s.rows.n_held] > 0.0:
        s.next_step = s.paces[s.rows.n_held]
    s.paced = s.rows.n_held


def of_force(s: Rubbing, g: int) -> bool:
    """Whether guard g tells of a force, that pulls or leaves its cone; the others tell of a gap or of sliding."""
    mode = s.mode[g // GUARDS]
    return mode != OPEN and (g % GUARDS == 0 or mode == STICKS)


def arrive(s: Rubbing, g: int) -> int:
    """The motion has come to the event of guard g: what comes next into `next`. A status."""
    c = g // GUARDS
    if not measure(s, s.clock.t0, s.y):
        return NOT_FINITE
    if of_force(s, g):
        s.next = OBEY if changes(s) else SETTLE
    elif s.mode[c] == OPEN:
        meet(s, c)
    else:
        stop(s, c)
    return DONE


def changes(s: Rubbing) -> bool:
    """Whether the modes that `look_ahead` has found are others than those at hand; else the state itself decides.

    A force that jumps may do so later than its guard's polynomial has seen it.
    """
    some = False
    for c in range(s.n_c):
        some = some or s.new_mode[c] != s.mode[c] or s.new_direction[c] != s.direction[c]
    if not some:
        find_standing(s)
    return some


def look_ahead(s: Rubbing, h: float) -> int:
    """The modes just after a force has left its cone, or turned to pulling; a status."""
    ahead = LOOK_AHEAD
    while True:
        s.at(s.found + ahead, s.seen)
        if not measure(s, s.clock.t0 + (s.found + ahead) * h, s.seen):
            return NOT_FINITE
        find_standing(s)
        code = decide(s)
        if code != DONE or not undecided(s) or ahead >= FARTHEST:
            break
        ahead *= FURTHER
    hold_modes(s)  # the old ones, for the rest of the step
    return code


def meet(s: Rubbing, c: int) -> None:
    """Contact c has come to its surface."""
    find_touching(s)
    lift(s, c)
    s.touches[c] = 1
    forget_terms(s)
    if not s.in_turn:
        part_before(s)
    s.next = JUMP


def stop(s: Rubbing, c: int) -> None:
    """The sliding velocity of contact c is zero."""
    find_standing(s)
    s.free[c] = 1
    stop_with(s, c)
    s.next = SETTLE


def stop_with(s: Rubbing, c: int) -> None:
    """Contacts that stop with contact c are those whose sliding velocity goes with what the step has left of its own.

    Feet of one body stop together, and the ends of a rod: a step is only as exact as its order, and what of one
    velocity it has left, it has of the others.
    """
    i = s.n_j + s.n_c + c
    own = gives(s, i)
    if not own > EDGE * s.W[i * s.n_r + i]:
        return
    for d in range(s.n_c):
        k = s.n_j + s.n_c + d
        with_it = s.velocity[i] * product(s.R, s.dv, k, s.n_q) / own
        if abs(s.velocity[k] - with_it) <= still(s, k) + EDGE * abs(with_it):
            s.free[d] = 1


def find_standing(s: Rubbing) -> None:
    """Which contacts do not slide: those that stick, and those of whose sliding velocity that cannot be told.

    Feet of one body that share a direction are among these: one of them is held, the others have a share of the load.
    """
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        rests = s.mode[c] == STICKS or s.mode[c] == LEANS
        s.free[c] = 1 if rests or abs(s.velocity[i]) <= still(s, i) else 0


def take_over(s: Rubbing, record: Record, tally: Tally, t: float, tau: float) -> None:
    """The motion over the first `tau` of the step is final: its impulses, the states asked for, the next base."""
    tally.steps += 1
    pressed = 0.0
    clear(s.counted, s.n_r)
    while record.wants(t, t >= s.t_end):
        wanted = record.awaited() - s.clock.t0
        press_between(s, pressed, wanted)
        pressed = wanted
        keep_wanted(s, record, wanted)
    if tau > 0.0:
        press_rest(s, pressed, tau)
        record.store(s.F, s.length)
        copy(s.y, s.y_new, 2 * s.n_q)
    s.clock.start_at(t)
    if tau > 0.0 and s.rows.n_held > 0:
        project(s.rows, t, s.q, s.v)


def keep_wanted(s: Rubbing, record: Record, tau: float) -> None:
    """Keep the state asked for next, tau from now: on the rows held, which dense output leaves by its own error."""
    t = record.awaited()
    if tau > 0.0:
        s.at(tau / s.length, s.seen)
        copy(s.dy, s.y, 2 * s.n_q)
        copy(s.y, s.seen, 2 * s.n_q)
        if s.rows.n_held > 0:
            project(s.rows, t, s.q, s.v)
        keep(s, record, t, s.y)
        copy(s.y, s.dy, 2 * s.n_q)
    else:
        keep(s, record, t, s.y)
    record.next_time += 1


def press_between(s: Rubbing, a: float, b: float) -> None:
    """Add the impulses of the forces between a and b after the base: Gauss' quadrature."""
    if s.rows.n_held == 0 or b <= a:
        return
    for k in range(s.n_nodes):
        tau = a + s.nodes[k] * (b - a)
        s.at(tau / s.length, s.seen)
        right_hand_side(s, s.clock.t0 + tau, s.seen, s.dy)
        share = s.weights[k] * (b - a)
        for i in range(s.n_r):
            add_impulse(s, i, share * s.multiplier[i])
            s.counted[i] = s.counted[i] + share * s.multiplier[i]


def press_rest(s: Rubbing, a: float, b: float) -> None:
    """Add the impulses of the rest of the step, which ends b after the base; up to a they have been counted."""
    if s.rows.n_held == 0:
        return
    if not sum_up(s):
        press_between(s, a, b)
        return
    late = b - s.length
    for i in range(s.n_r):
        add_impulse(s, i, s.total[i] + late * s.loads[STAGES * s.n_r + i] - s.counted[i])


def sum_up(s: Rubbing) -> bool:
    """The impulses of the whole step by its own weights; False where an estimated error is above the tolerance."""
    for i in range(s.n_r):
        total, e5, e3 = 0.0, 0.0, 0.0
        for j in range(STAGES + 1):
            load = s.loads[j * s.n_r + i]
            total += s.A[STAGES * ALL + j] * load
            e5 += s.E5[j] * load
            e3 += s.E3[j] * load
        s.total[i] = s.length * total
        tolerance, error = s.atol + s.rtol * abs(s.total[i]), e5 * e5 + 0.01 * e3 * e3
        if s.length * e5 * e5 > tolerance * sqrt(error):
            return False
    return True
