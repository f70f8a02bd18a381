"""Impacts with friction of all contacts that are closed at one time, and the end of chattering, as kernels.

    xi = u+ + r u-  on normals and tangents,  0 <= xi_N  complementary to  p_N >= 0,  p_T = -mu p_N sign(xi_T)

Moreau's law: with one restitution for normals and tangents of all that strike together it creates no energy; with
none on the tangents it is Newton's, and may. Impacts integrated over their impulse, in turn: `kernels.energetic`.
Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (CISM 302, 1988).

A contact that hops no higher than the tolerance is closed: the rest of its impacts, summed up, is the impulse that
takes its velocity, with the friction that belongs to it, and the forces of the closed contact make up for the rest.
"""

from __future__ import annotations

import cython

from lcpstep.events.friction.codes import ACCUMULATION, IMPACT, JAM, JUMP, OPEN, SLIDES, STICKS
from lcpstep.events.general.ends import NO_IMPULSES
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, PAINLEVE_INCONSISTENT, TOO_MANY_EVENTS

if not cython.compiled:
    from lcpstep.events.friction.cycle import look_back, recurs, sum_up
    from lcpstep.events.friction.equations import (
        apply,
        gap_tolerance,
        measure,
        measure_velocities,
        rounding_of_gap,
        rubs,
        speed_tolerance,
    )
    from lcpstep.events.friction.held import hold_modes, stop_rows
    from lcpstep.events.friction.keep import put_on_account
    from lcpstep.events.friction.parting import approaches, let_go, rejoin
    from lcpstep.events.friction.problem import fill, list_unknowns, row_of
    from lcpstep.events.friction.state import Rubbing
    from lcpstep.events.rows.equations import size_of
    from lcpstep.events.rows.held import constrain, hold_joints
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.coulomb import solve_contacts
    from lcpstep.kernels.energetic import strike_in_turn
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.recurrence import looks_back
    from lcpstep.kernels.tally import Tally
    from lcpstep.kernels.vectors import clear, copy, product
    from lcpstep.pointers import abs, after, inf, min

ROUNDS = 1000  # problems of impacts at one instant
STILL = 100.0  # tolerances: a sliding velocity this small at an event is zero


def jump(s: Rubbing, record: Record, tally: Tally, t: float) -> int:
    """Impacts until no contact on its surface approaches; those that are left without speed are closed.

    Impacts that go to and fro are summed where they fade in proportion; those that do not, as in a wedge that closes,
    end in a plastic one of all contacts that touch.
    """
    while s.rounds < 2 * ROUNDS:
        if not approaches(s):
            rejoin(s)
            find_free(s)
            return DONE
        if record.full(4 * s.n_c + 4):
            return BUFFER_FULL
        ratio = recurs(s) if s.rounds > 0 else 0.0
        if ratio > 0.0:
            sum_up(s, record, tally, t, ratio)
        else:
            if looks_back(s.rounds):
                look_back(s)
            if s.rounds > 0 and not s.in_turn and not let_go(s, t):
                return NOT_FINITE
            s.rounds += 1
            if not strike(s, record, tally, t, s.rounds > ROUNDS):
                return NO_IMPULSES
    return TOO_MANY_EVENTS


def strike(s: Rubbing, record: Record, tally: Tally, t: float, plastic: bool) -> bool:
    """The impact of contacts that are closed or approach, or a plastic one of all that touch; False: none found.

    What is held from all sides cannot leave every obstacle as its restitution asks: where no impulses answer, the
    impact is a plastic one.
    """
    for c in range(s.n_c):
        i = s.n_j + c
        s.before[c] = s.velocity[i] if s.mode[c] == OPEN else 0.0
        if s.mode[c] == STICKS:
            s.velocity[i + s.n_c] = 0.0
        s.free[c] = 1
    if strike_together(s, record, tally, t, plastic):
        return True
    return not plastic and strike_together(s, record, tally, t, True)


def strike_together(s: Rubbing, record: Record, tally: Tally, t: float, plastic: bool) -> bool:
    """`strike` by one of the laws, from the velocities before it."""
    for c in range(s.n_c):
        least = s.terms[c] if s.parting[c] == 0 else -s.terms[c]
        if s.mode[c] == OPEN and s.touches[c] == 1 and (plastic or s.in_turn or s.before[c] <= least):
            s.mode[c] = SLIDES
    s.coefficients.use(s.problem.mu)
    hold_joints(s.rows)
    n_a, n_f = list_unknowns(s)
    fill(s, n_a, n_f)
    if not find_impulses(s, n_a, n_f, plastic):
        return False
    strike_with(s, record, tally, t, n_a, n_f, -1, plastic)
    return True


def strike_with(
    s: Rubbing, record: Record, tally: Tally, t: float, n_a: int, n_f: int, jammed: int, plastic: bool
) -> None:
    """Apply the impulses found, and close or open the contacts by the velocities that they leave.

    A plastic one stands for impacts without end, and is told as such where the law of a contact is another.
    """
    for a in range(n_a + n_f):
        apply(s, row_of(s, a, n_a), s.problem.impulse[a])
    hold_joints(s.rows)
    stop_rows(s)
    measure_velocities(s, s.v)
    for a in range(n_a):
        c = s.problem.ids[a]
        u = s.velocity[s.n_j + c]
        if s.problem.impulse[a] > 0.0:
            kind = ACCUMULATION if plastic and s.model.restitution[c] > 0.0 else IMPACT
            kind = JAM if c == jammed else kind
            before = 0.0 if s.thrown[c] == 1 else s.before[c]  # its obstacle takes it along
            s.clock.log(record, tally, t, c, kind, before, u, s.problem.impulse[a])
        s.mode[c], s.thrown[c] = OPEN if u > s.terms[c] else SLIDES, 0


def find_impulses(s: Rubbing, n_a: int, n_f: int, plastic: bool) -> bool:
    """Impulses of n_a contacts, n_f of them with tangents, by the law of impact; False where there are none.

    An obstacle whose velocity jumps takes along what lies on it: u- = 0.
    """
    own = s.in_turn or plastic
    for a in range(n_a):
        c = s.problem.ids[a]
        r = 0.0 if s.thrown[c] == 1 else s.model.restitution[c]
        s.problem.rate[a] = s.before[c] if own else (1.0 + r) * min(s.before[c], 0.0)
        s.problem.slow[a] = inf if s.thrown[c] == 1 else 0.0
    for f in range(n_f):
        c = s.problem.ids[s.problem.carrier[f]]
        share = 1.0 if own or s.thrown[c] == 1 else 1.0 + s.tangential[c]
        s.problem.rate[n_a + f] = share * s.velocity[s.n_j + s.n_c + c]
    if s.in_turn and not plastic:
        return strike_in_turn(s.problem, s.model.restitution, n_a, n_f, -1)
    return solve_contacts(s.problem, n_a, n_f)


def jam(s: Rubbing, record: Record, tally: Tally, t: float) -> int:
    """The impact without collision of the contact that jams (`culprit`), at the base state; a status.

    Its force grows beyond all bounds while it slides: an impulse that presses it together until the sliding ends, and
    what follows of the impact. By the laws that do not integrate it the normal has no restitution, as u- = 0.
    """
    if not measure(s, t, s.y):
        return NOT_FINITE
    if record.full(4 * s.n_c + 4):
        return BUFFER_FULL
    hit, first = s.culprit, -1
    copy(s.instant, s.impulse, s.n_r)
    for c in range(s.n_c):
        s.before[c] = s.velocity[s.n_j + c] if s.mode[c] == OPEN else 0.0
        s.free[c], s.touches[c] = 1, 1 if s.mode[c] != OPEN else 0
    s.coefficients.use(s.problem.mu)
    hold_joints(s.rows)
    n_a, n_f = list_unknowns(s)
    fill(s, n_a, n_f)
    for a in range(n_a):
        s.problem.rate[a] = 0.0
        s.problem.slow[a] = 0.0 if s.in_turn else inf
        if s.problem.ids[a] == hit:
            first = a
    for f in range(n_f):
        s.problem.rate[n_a + f] = s.velocity[s.n_j + s.n_c + s.problem.ids[s.problem.carrier[f]]]
    done = first >= 0 and strike_in_turn(s.problem, s.model.restitution, n_a, n_f, first)
    if not (done and s.problem.impulse[first] > 0.0):
        return PAINLEVE_INCONSISTENT
    s.jams += 1
    strike_with(s, record, tally, t, n_a, n_f, hit, False)
    clear(s.problem.slow, s.n_c)
    s.next = JUMP
    return DONE


def find_free(s: Rubbing) -> None:
    """Which closed contacts have no sliding velocity; the direction of the others.

    What an impact keeps from sliding it leaves without speed but for rounding. Beside hops of a chattering slower
    sliding than the tolerance is no rest: to stop it would feed them without end.
    """
    for c in range(s.n_c):
        i = s.n_j + s.n_c + c
        least = s.terms[s.n_c + c] if s.rounds > 0 else still(s, i)
        s.free[c] = 1 if abs(s.velocity[i]) <= least else 0
        if s.free[c] == 1:
            s.velocity[i] = 0.0
        else:
            s.direction[c] = 1.0 if s.velocity[i] > 0.0 else -1.0


def still(s: Rubbing, i: int) -> float:
    """The velocity of row i below which it is zero."""
    return NOISE * size_of(s.rows, i, s.rate[i], s.v) + STILL * speed_tolerance(s, i)


def close_small(s: Rubbing, record: Record, tally: Tally, t: float) -> bool:
    """Close a contact whose hops no longer matter; whether there was one. Modes must be obeyed, `v` measured."""
    copy(s.a, s.a_free, s.n_q)
    constrain(s.rows, s.a, s.bias)
    for c in range(s.n_c):
        i = s.n_j + c
        u, alpha = s.velocity[i], product(s.R, s.a, i, s.n_q) + s.bias[i]
        if s.mode[c] == OPEN and s.touches[c] == 1 and alpha < 0.0 and is_over(s, c, u, -0.5 * u * u / alpha):
            close(s, c)
            s.clock.log(record, tally, t, c, ACCUMULATION, u, 0.0, 0.0)
            return True
    return False


def is_over(s: Rubbing, c: int, u: float, height: float) -> bool:
    """Whether hops of contact c that begin with the speed u, and rise to this height, no longer matter.

    What other contacts make of the impacts that are left out is of the size of the speed, not of the height; so is
    what elastic ones would go on with for ever.
    """
    slow = u <= speed_tolerance(s, s.n_j + c)
    if s.model.restitution[c] < 1.0:
        slow = slow or s.n_c == 1 or height <= rounding_of_gap(s, c)
    return slow and height <= gap_tolerance(s, c)


def close(s: Rubbing, c: int) -> None:
    """Take the velocity of contact c, which slides on as before, unless that stops it."""
    i = s.n_j + s.n_c + c
    slip, rough = s.velocity[i], rubs(s, c)
    s.loaded[c], s.direction[c] = 1, 1.0 if slip >= 0.0 else -1.0
    s.mode[c] = SLIDES if not rough or abs(slip) > still(s, i) else STICKS
    if s.mode[c] == SLIDES and rough and not slides_on(s, i, slip):
        s.mode[c] = STICKS
    if not hold_modes(s):  # sliding on would take the others' forces away: in a wedge all come to rest
        for d in range(s.n_c):
            s.mode[d] = STICKS if s.mode[d] != OPEN and rubs(s, d) else s.mode[d]
        hold_modes(s)
    copy(s.account, s.impulse, s.n_r)
    copy(s.seen, s.v, s.n_q)
    stop_rows(s)
    if leaves_cone(s, c):
        take_back(s, c)
    put_on_account(s)
    measure_velocities(s, s.v)
    find_free(s)


def slides_on(s: Rubbing, i: int, slip: float) -> bool:
    """Whether what the modes hold can be stopped, and leaves row i its direction of sliding."""
    if not hold_modes(s):
        return False
    copy(s.dv, s.v, s.n_q)
    constrain(s.rows, s.dv, s.rate)
    return (product(s.R, s.dv, i, s.n_q) + s.rate[i]) * slip > 0.0


def leaves_cone(s: Rubbing, c: int) -> bool:
    """Whether contact c, just stopped, has more friction at this instant than belongs to what its normal has had."""
    normal, friction = s.impulse[c] - s.instant[c], s.impulse[s.n_c + c] - s.instant[s.n_c + c]
    return normal < 0.0 or abs(friction) > (1.0 + NOISE) * s.mu_s[c] * normal


def take_back(s: Rubbing, c: int) -> None:
    """Stop contact c from before in another way: of its impact so much that none is left, in its own proportion.

    An impact whose restitution turns the sliding has other friction than the sliding that it leaves; Moreau's law is
    plastic then. A friction beyond the cone would do work.
    """
    normal, friction = s.account[c] - s.instant[c], s.account[s.n_c + c] - s.instant[s.n_c + c]
    if normal <= 0.0:
        return
    mode, direction, s.mode[c] = s.mode[c], s.direction[c], SLIDES
    s.direction[c] = -friction / (s.mu[c] * normal) if s.mu[c] > 0.0 else direction
    if hold_modes(s):
        copy(s.v, s.seen, s.n_q)
        copy(s.impulse, s.account, s.n_r)
        stop_rows(s)
    s.mode[c], s.direction[c] = mode, direction


def forget_terms(s: Rubbing) -> None:
    """A new instant: what rounding leaves of gap velocities is that of the velocities at hand."""
    s.rounds = 0
    copy(s.instant, s.impulse, s.n_r)
    clear(s.terms, 2 * s.n_c)
    for c in range(s.n_c):
        s.parting[c] = s.thrown[c] = 0
    measure_velocities(s, after(s.y, s.n_q))
