"""Impacts of all contacts that are closed at one time, as kernels.

    xi = u+ + r u-  on normals and tangents,  0 <= xi_N  complementary to  p_N >= 0,  p_T = -mu p_N sign(xi_T)

Moreau's law: with one restitution for normals and tangents of all that strike together it creates no energy; with
none on the tangents it is Newton's, and may. A velocity u- > 0 is rounding (`gather`), and counts as 0. Impacts
integrated over their impulse, in turn: `kernels.energetic`.
Source: J. J. Moreau, Unilateral contact and dry friction in finite freedom dynamics (CISM 302, 1988).
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import ACCUMULATION, IMPACT, JAM, LEANS, NO_IMPULSES, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.equations import renew_friction
from lcpstep.events.contacts.parting import close_or_find_approach, let_go, pass_by, rejoin
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.surfaces import GONE
from lcpstep.events.rows.contacts import has_stopped, measure_velocities, sliding, still_below, stop_joints
from lcpstep.events.rows.cycle import ROUNDS, close_if_faded, look_back, recurs, sum_up
from lcpstep.events.rows.exchange import leave_for_later, some_exchange
from lcpstep.events.rows.held import hold_joints
from lcpstep.events.rows.problem import fill, list_unknowns, row_of
from lcpstep.kernels.coulomb import solve_contacts
from lcpstep.kernels.energetic import strike_in_turn
from lcpstep.kernels.recurrence import FOR_EVER, looks_back
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, TOO_MANY_EVENTS
from lcpstep.kernels.vectors import clear, copy_indices
from lcpstep.pointers import abs, after, inf, max, min


def jump(s: Rubbing) -> int:
    """Impacts until no contact on its surface approaches; those that are left without speed are closed.

    `begin_instant` has set `rounds` to zero, and a full record leaves it as it is.
    Impacts that go to and fro are summed where they fade in proportion, and have no end where all returns as it was;
    others, as in a wedge that closes, end in a plastic one of all contacts that touch, if there is friction.
    """
    most = ROUNDS if s.n_t == 0 else 2 * ROUNDS
    if s.rows.rounds == 0:
        s.rows.stalled = s.rows.tally.stalled
        pass_by(s)
    while s.rows.rounds < most:
        if not close_or_find_approach(s):
            rejoin(s)
            find_who_may_stick(s)
            if s.rows.tally.stalled > s.rows.stalled + 1:  # the impacts of one instant count as one
                s.rows.tally.stalled = s.rows.stalled + 1
            return DONE
        if s.rows.record.full(4 * s.n_c + 4):
            return BUFFER_FULL
        if s.rows.tally.events > s.rows.tally.max_events:
            return TOO_MANY_EVENTS
        if s.rows.rounds > 0 and not renew_friction(s):
            return NOT_FINITE
        ratio = recurs(s.rows) if s.rows.rounds > 0 else 0.0
        if ratio >= FOR_EVER:
            if not close_if_faded(s.rows):
                return TOO_MANY_EVENTS if try_rest(s) else NO_IMPULSES
        elif ratio > 0.0:
            sum_up(s.rows, ratio)
        else:
            if looks_back(s.rows.rounds):
                look_back(s.rows)
            if s.rows.rounds > 0 and not s.in_turn and not let_go(s):
                return NOT_FINITE
            s.rows.rounds += 1
            # The last ones of what is held from all sides may leave speeds that but rounding contradicts
            if not strike(s, s.rows.rounds > ROUNDS) and not (s.rows.rounds > 1 and close_if_faded(s.rows)):
                return NO_IMPULSES
    return TOO_MANY_EVENTS


def strike(s: Rubbing, plastic: bool) -> bool:
    """The impact of contacts that are closed or approach, or a plastic one of all that touch; False: none found.

    What is held from all sides cannot leave every obstacle as its restitution asks: where no impulses answer, the
    impact is a plastic one. With friction there are some that are hard to find.
    """
    look_before(s)
    copy_indices(s.tried, s.mode, s.n_c)
    found = strike_by_either(s, plastic)
    if not found and s.n_t > 0:
        # The plastic one has closed all that touch, and not only what is struck
        copy_indices(s.mode, s.tried, s.n_c)
        s.problem.work.thorough = True
        found = strike_by_either(s, plastic)
        s.problem.work.thorough = False
    return found


def strike_by_either(s: Rubbing, plastic: bool) -> bool:
    """By its own law, if not `plastic`, or a plastic one."""
    return strike_together(s, plastic) or (not plastic and strike_together(s, True))


def look_before(s: Rubbing) -> None:
    """The velocities before an impact, or before the jump at a corner; what is closed has none but rounding.

    In the impact every contact may stick: all that rub have a friction unknown each.
    """
    for c in range(s.n_c):
        s.before[c] = s.velocity[s.n_j + c] - s.jumped[c]
        if s.mode[c] != OPEN:
            s.terms[c], s.before[c] = max(s.terms[c], abs(s.before[c])), 0.0
        if s.n_t > 0:
            take_for_none(s, c)
        s.may_stick[c] = 1


def try_rest(s: Rubbing) -> bool:
    """Whether a plastic impact would bring to rest what is struck in turn for ever: not between walls that close.

    Modes are put back where it would; else all that touch are left closed, for the message names them.
    """
    look_before(s)
    copy_indices(s.tried, s.mode, s.n_c)
    n_a, n_f = gather(s, True)
    found = find_impulses(s, n_a, n_f, True)
    copy_indices(s.mode, s.tried, s.n_c if found else 0)
    return found


def take_for_none(s: Rubbing, c: int) -> None:
    """Set a sliding velocity of contact c below rounding to zero; where it sticks or leans, below `still_below`.

    What is left of a velocity that has died away, say 1e-49, would keep solvers from an answer beside others.
    """
    i, T = s.n_c + c, s.n_j + s.n_c + c
    least = still_below(s.rows, T) if s.mode[c] in (STICKS, LEANS) else s.terms[i]
    if abs(s.velocity[T]) <= least:
        s.terms[i] = max(s.terms[i], abs(s.velocity[T]))
        s.velocity[T] = 0.0


def strike_together(s: Rubbing, plastic: bool) -> bool:
    """`strike` by one of the laws, from the velocities before it."""
    n_a, n_f = gather(s, plastic)
    if not find_impulses(s, n_a, n_f, plastic):
        return False
    strike_with(s, n_a, n_f, -1, plastic)
    return True


def gather(s: Rubbing, plastic: bool) -> tuple[int, int]:
    """The contacts that take part in an impact, which are closed from now on, and their problem; see `pose`."""
    n = 0
    for c in range(s.n_c):
        u, least = s.before[c], s.terms[c]
        struck = u <= least if s.parting[c] == 0 else u < -least
        if s.mode[c] != OPEN or (s.touches[c] == 1 and (plastic or s.in_turn or struck)):
            s.problem.ids[n] = c  # a mere list: `pose` writes that of the problem
            n += 1
    if not plastic and follow_each_other(s, n):
        n = leave_for_later(s.rows, n, s.length == 0.0)  # no step was ever made
    for a in range(n):
        if s.mode[s.problem.ids[a]] == OPEN:
            s.mode[s.problem.ids[a]] = SLIDES
    return pose(s)


def follow_each_other(s: Rubbing, n: int) -> bool:
    """Whether two of n contacts, without friction or joints beside, strike one after another."""
    for c in range(s.n_c):
        if s.jumped[c] != 0.0:
            return False
    return s.n_t == 0 and s.n_j == 0 and some_exchange(s.rows, n, s.length == 0.0)


def pose(s: Rubbing) -> tuple[int, int]:
    """The matrix of the closed contacts on the joints; how many there are, and how many have unknown friction."""
    s.coefficients.use(s.problem.mu)
    hold_joints(s.rows)
    n_a, n_f = list_unknowns(s.rows)
    fill(s.rows, n_a, n_f)
    return n_a, n_f


def strike_with(s: Rubbing, n_a: int, n_f: int, jammed: int, plastic: bool) -> None:
    """Apply the impulses found, and close or open the contacts by the velocities that they leave.

    jammed : the contact whose sliding has jammed; -1: none, an impact; n_c: several together have
    A plastic one stands for impacts without end, and is told as such where the law of a contact is another.
    """
    t = s.rows.t0
    for a in range(n_a + n_f):
        s.rows.push(row_of(s.rows, a, n_a), s.problem.impulse[a])
    stop_joints(s.rows)
    for a in range(n_a):
        c = s.problem.ids[a]
        u = s.velocity[s.n_j + c]
        if s.problem.impulse[a] > 0.0:
            if jammed < 0 and not (plastic or s.in_turn):
                u = 0.0 - s.model.restitution[c] * min(s.before[c], 0.0)  # by the law
            kind = ACCUMULATION if plastic and s.model.restitution[c] > 0.0 else IMPACT
            kind = JAM if c == jammed or jammed == s.n_c else kind
            s.rows.log(t, c, s.before[c], u, s.problem.impulse[a], kind)
            s.rows.since[c], s.rows.struck[c], s.carried[c] = t - s.rows.struck[c], t, 0
        s.mode[c], s.jumped[c] = OPEN if u > s.terms[c] else SLIDES, 0.0


def find_impulses(s: Rubbing, n_a: int, n_f: int, plastic: bool) -> bool:
    """Impulses of n_a contacts, n_f of them with tangents, by the law of impact; False where there are none.

    By Moreau's law u+ + r u- = W p + rate: `rate` is (1 + r) min(u-, 0), and what has jumped at a corner; on
    tangents (1 + r) u-, with their own r. Of a plastic impact, and of impacts in turn, it has u- instead.
    """
    own = s.in_turn or plastic
    for a in range(n_a):
        c = s.problem.ids[a]
        rate = s.before[c] if own else (1.0 + s.model.restitution[c]) * min(s.before[c], 0.0)
        s.problem.rate[a] = rate + s.jumped[c]
        s.problem.slow[a] = inf if taken_along(s, c) else 0.0
    for f in range(n_f):
        c = s.problem.ids[s.problem.carrier[f]]
        share = 1.0 if own or taken_along(s, c) else 1.0 + s.tangential[c]
        s.problem.rate[n_a + f] = share * s.velocity[s.n_j + s.n_c + c]
    if s.in_turn and not plastic:
        return strike_in_turn(s.problem, s.model.restitution, n_a, n_f, -1)
    return solve_contacts(s.problem, n_a, n_f)


def taken_along(s: Rubbing, c: int) -> bool:
    """Whether contact c, which was closed, strikes as the velocity of its obstacle jumps: u- = 0."""
    return s.jumped[c] != 0.0 and s.before[c] == 0.0


def find_who_may_stick(s: Rubbing) -> None:
    """Which closed contacts have no sliding velocity; the direction of the others.

    What an impact keeps from sliding it leaves without speed but for rounding. Beside hops of a chattering slower
    sliding than the tolerance is no rest: to stop it would feed them without end.
    """
    for c in range(s.n_c):
        s.may_stick[c] = 1 if stands(s, c) else 0
        if s.n_t > 0 and s.may_stick[c] == 1:
            s.velocity[s.n_j + s.n_c + c] = 0.0
        elif s.may_stick[c] == 0:
            s.direction[c] = 1.0 if sliding(s.rows, c) > 0.0 else -1.0


def stands(s: Rubbing, c: int) -> bool:
    """Whether contact c has no sliding velocity, between or after the impacts of an instant."""
    if s.rows.rounds == 0 or s.n_t == 0:
        return has_stopped(s.rows, c)
    return abs(sliding(s.rows, c)) <= s.terms[s.n_c + c]


def begin_instant(s: Rubbing) -> None:
    """A new instant: no impact yet, no jump; what rounding leaves of gap velocities is that of those at hand.

    Next to nothing is none: hops of a body at rest in a heap, on which no force acts but those of others, may else
    fade until no number tells them apart.
    """
    s.rows.rounds = 0
    clear(s.instant, s.n_r)
    for i in range(2 * s.n_c):
        s.terms[i] = GONE * s.rows.atol
    for c in range(s.n_c):
        s.parting[c], s.jumped[c] = 0, 0.0
    measure_velocities(s.rows, after(s.y, s.n_q))
