"""A contact whose hops no longer matter is closed, as kernels; see `chatter`.

The rest of its impacts, summed up, is the impulse that takes its velocity, with the friction that belongs to it, and
the forces of the closed contact make up for the rest.
"""

from __future__ import annotations

import cython

from lcpstep.events.contacts.codes import OPEN, SLIDES, STICKS

if not cython.compiled:
    from lcpstep.events.contacts.equations import measure_velocities, of_tangent, rubs, sliding
    from lcpstep.events.contacts.held import hold_modes, take_velocities
    from lcpstep.events.contacts.impact import find_free, still
    from lcpstep.events.contacts.keep import put_on_account
    from lcpstep.events.contacts.state import Rubbing
    from lcpstep.events.rows.held import constrain
    from lcpstep.kernels.clock import NOISE
    from lcpstep.kernels.vectors import copy, product
    from lcpstep.pointers import abs


def close(s: Rubbing, c: int, at_rest: bool) -> None:
    """Take the velocity of contact c, which slides on as before, unless that stops it; or its sliding, too."""
    i = s.n_j + s.n_c + c
    slip, rough = sliding(s, c), rubs(s, c)
    s.loaded[c], s.direction[c] = 1, 1.0 if slip >= 0.0 else -1.0
    s.mode[c] = STICKS if at_rest else mode_closed(s, c)
    if s.mode[c] == SLIDES and rough and not slides_on(s, i, slip):
        s.mode[c] = STICKS
    if not hold_modes(s):  # sliding on would take the others' forces away: in a wedge all come to rest
        for d in range(s.n_c):
            s.mode[d] = STICKS if s.mode[d] != OPEN and rubs(s, d) else s.mode[d]
        hold_modes(s)
    copy(s.seen, s.v, s.n_q)
    take_velocities(s)
    if not at_rest and leaves_cone(s, c):
        take_back(s, c)
    put_on_account(s)
    measure_velocities(s, s.v)
    find_free(s)


def mode_closed(s: Rubbing, c: int) -> int:
    """The mode in which contact c is closed: it slides on, if it does."""
    i = s.n_j + s.n_c + c
    return SLIDES if not rubs(s, c) or abs(sliding(s, c)) > still(s, i) else STICKS


def slides_on(s: Rubbing, i: int, slip: float) -> bool:
    """Whether what the modes hold can be stopped, and leaves row i its direction of sliding."""
    if not hold_modes(s):
        return False
    copy(s.dv, s.v, s.n_q)
    constrain(s.rows, s.dv, s.rate)
    return (product(s.R, s.dv, i, s.n_q) + s.rate[i]) * slip > 0.0


def leaves_cone(s: Rubbing, c: int) -> bool:
    """Whether contact c, just stopped, has more friction at this instant than belongs to what its normal has had."""
    i, friction = s.n_j + c, of_tangent(s, s.instant, c)
    normal = s.instant[c] + s.multiplier[i]
    if s.n_t > 0:
        friction += s.multiplier[i + s.n_c]
    return normal < 0.0 or abs(friction) > (1.0 + NOISE) * s.mu_s[c] * normal


def take_back(s: Rubbing, c: int) -> None:
    """Stop contact c from before in another way: of its impact so much that none is left, in its own proportion.

    An impact whose restitution turns the sliding has other friction than the sliding that it leaves; Moreau's law is
    plastic then. A friction beyond the cone would do work.
    """
    normal, friction = s.instant[c], of_tangent(s, s.instant, c)
    if normal <= 0.0:
        return
    mode, direction, s.mode[c] = s.mode[c], s.direction[c], SLIDES
    s.direction[c] = -friction / (s.mu[c] * normal) if s.mu[c] > 0.0 else direction
    if hold_modes(s):
        copy(s.v, s.seen, s.n_q)
        take_velocities(s)
    s.mode[c], s.direction[c] = mode, direction
