"""Contacts whose hops no longer matter are closed, as kernels; see `events.rows.chatter`.

The rest of its impacts, summed up, is the impulse that takes the velocity of a contact, with the friction that
belongs to it, and the forces of the closed contact make up for the rest.
"""

from __future__ import annotations

from math import sqrt

import cython

from lcpstep.events.codes import OPEN, SLIDES, STICKS
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.held import know_rows
from lcpstep.events.contacts.impact import find_who_may_stick
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.chatter import (
    disturbs,
    find_over,
    hops_beside,
    just_opened,
    meets,
    moves,
    passes_on,
    take_along,
    tell_over,
)
from lcpstep.events.rows.contacts import (
    gap_tolerance,
    hold_modes,
    list_multipliers,
    measure_velocities,
    of_tangent,
    rubs,
    sliding,
    still_below,
)
from lcpstep.events.rows.equations import acceleration_of, size_of, velocity_of
from lcpstep.events.rows.held import constrain, is_held
from lcpstep.events.rows.keep import put_on_account
from lcpstep.events.rows.problem import accelerate
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import abs, after, max, nan


def close_small(s: Rubbing) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there were any.

    Modes must be obeyed, everything measured at the base.
    """
    accelerate(s.rows)
    for c in range(s.n_c):
        s.rows.curve[c] = acceleration_of(s.rows, s.n_j + c, s.a)
    if not find_over(s.rows) or not stays_so(s):
        return False
    take_along(s.rows)
    if disturbs(s.rows):
        return False
    for c in range(s.n_c):
        if s.rows.left[c] >= 0.0:
            tell_over(s.rows, c)
            close(s, c)
    for c in range(s.n_c):  # of those that the others, closed, have left without speed the forces decide
        if just_opened(s.rows, c):
            s.mode[c] = SLIDES
    find_who_may_stick(s)
    return True


def rests(s: Rubbing, c: int) -> bool:
    """Whether forces would undo the sliding of contact c within a way that rounding hides, and nothing hops on.

    Of sliding that dies away with hops this is what steps and times leave: with `mu` in the place of `mu_s` it would
    go on. Beside others that hop on sliding passes through zero, and does not rest there.
    """
    i = s.n_j + s.n_c + c
    if not rubs(s.rows, c) or s.mu_s[c] == s.mu[c] or hops_beside(s.rows, c, True):
        return False
    pull = abs(acceleration_of(s.rows, i, s.a))
    most = sqrt(2.0 * pull * NOISE * size_of(s.rows, i, 0.0, s.q))
    return abs(sliding(s.rows, c)) <= max(most, still_below(s.rows, i))


def stops_others(s: Rubbing, c: int, T: float) -> bool:
    """Whether a contact that impacts connect with contact c, and that slides, comes to rest within the time T.

    Each impact may set it in motion again: it has less friction than one that slides on. Not where the next one would
    leave it with sliding that cannot be told from none: stopped by that, it would feed the hops.
    """
    passed_on = passes_on(s.rows, c)
    for d in range(s.n_c):
        k, slip = s.n_j + s.n_c + d, sliding(s.rows, d)
        if d != c and s.mode[d] == SLIDES and rubs(s.rows, d) and (passed_on or meets(s.rows, c, k)):
            stops = slip * (slip + T * acceleration_of(s.rows, k, s.a)) < 0.0
            if stops and s.model.restitution[c] * abs(slip) > still_below(s.rows, k):
                return True
    return False


def stays_so(s: Rubbing) -> bool:
    """Whether any sequence is left to be summed up, of those whose acceleration does not change too much meanwhile.

    The end is then off by T change / |alpha|, in which the gap's terms move by no more than the tolerance.
    """
    some = False
    for c in range(s.n_c):
        T, alpha = s.rows.left[c], s.rows.curve[c]
        if T > 0.0 and stops_others(s, c, T):
            s.rows.left[c] = -1.0
        elif T > 0.0:
            speed = max(s.terms[c] / NOISE, -alpha * s.scan_length)
            change = abs(later(s, c, T) - alpha)
            if not change * T * speed <= -alpha * gap_tolerance(s.rows, c):
                s.rows.left[c] = -1.0
        some = some or s.rows.left[c] >= 0.0
    return some


def later(s: Rubbing, c: int, T: float) -> float:
    """Gap acceleration of contact c at the time T from now, along the tangent of the motion."""
    n, i, curve = s.n_q, s.n_j + c, nan
    q, v = s.seen, after(s.seen, n)
    for j in range(n):
        q[j] = s.q[j] + T * s.v[j]
        v[j] = s.v[j] + T * s.a[j]
    if know_rows(s, s.rows.t0 + T):
        curve = acceleration_of(s.rows, i, after(s.dy, n))
    measure(s, s.rows.t0, s.y)
    hold_modes(s.rows)
    return curve


def close(s: Rubbing, c: int) -> None:
    """Take the velocity of contact c, which slides on as before, unless it rests, or that stops it."""
    i = s.n_j + s.n_c + c
    slip, rough, at_rest = sliding(s.rows, c), rubs(s.rows, c), rests(s, c)
    s.loaded[c], s.direction[c] = 1, 1.0 if slip >= 0.0 else -1.0
    s.mode[c] = STICKS
    at_rest = at_rest and hold_modes(s.rows)
    s.mode[c] = STICKS if at_rest else s.rows.mode_closed(c)
    if s.mode[c] == SLIDES and rough and not slides_on(s, i, slip):
        s.mode[c] = STICKS
    if not hold_modes(s.rows):  # sliding on would take the others' forces away: in a wedge all come to rest
        for d in range(s.n_c):
            s.rows.tried[d] = 0
        bring_to_rest(s, c)
        hold_modes(s.rows)
    copy(s.seen, s.v, s.n_q)
    take_velocities(s)
    if not at_rest and leaves_cone(s, c):
        take_back(s, c)
    put_on_account(s.rows)
    measure_velocities(s.rows, s.v)
    find_who_may_stick(s)


def take_velocities(s: Rubbing) -> None:
    """Take their velocities from the rows held; the impulses that do so by row into `multiplier`, not counted."""
    constrain(s.rows, s.v, s.rate)
    list_multipliers(s.rows)


def bring_to_rest(s: Rubbing, c: int) -> None:
    """Contact c sticks, if it rubs, and so do those not `tried` yet that closed ones, or joints, connect with it."""
    s.rows.tried[c], s.mode[c] = 1, STICKS if rubs(s.rows, c) else s.mode[c]
    for d in range(s.n_c):
        if s.mode[d] != OPEN and s.rows.tried[d] == 0 and moves(s.rows, c, d):
            bring_to_rest(s, d)


def slides_on(s: Rubbing, i: int, slip: float) -> bool:
    """Whether what the modes hold can be stopped, and leaves row i its direction of sliding.

    On the edge where it jams, its friction takes all that its normal force does: that stops nothing.
    """
    if not hold_modes(s.rows):
        return False
    copy(s.dv, s.v, s.n_q)
    constrain(s.rows, s.dv, s.rate)
    k = i - s.n_c
    u = velocity_of(s.rows, k, s.dv)
    stopped = is_held(s.rows, k) or abs(u) <= s.rows.noise(k - s.n_j)
    return stopped and velocity_of(s.rows, i, s.dv) * slip > 0.0


def leaves_cone(s: Rubbing, c: int) -> bool:
    """Whether contact c, just stopped, has more friction at this instant than belongs to what its normal has had."""
    i, friction = s.n_j + c, of_tangent(s.rows, s.instant, c)
    normal = s.instant[c] + s.multiplier[i]
    if s.n_t > 0:
        friction += s.multiplier[i + s.n_c]
    return normal < 0.0 or abs(friction) > (1.0 + NOISE) * s.mu_s[c] * normal


def take_back(s: Rubbing, c: int) -> None:
    """Stop contact c from before in another way: of its impact so much that none is left, in its own proportion.

    An impact whose restitution turns the sliding has other friction than the sliding that it leaves; Moreau's law is
    plastic then. A friction beyond the cone would do work.
    """
    normal, friction = s.instant[c], of_tangent(s.rows, s.instant, c)
    if normal <= 0.0:
        return
    mode, direction, s.mode[c] = s.mode[c], s.direction[c], SLIDES
    s.direction[c] = -friction / (s.mu[c] * normal) if s.mu[c] > 0.0 else direction
    if hold_modes(s.rows):
        copy(s.v, s.seen, s.n_q)
        take_velocities(s)
    s.mode[c], s.direction[c] = mode, direction
