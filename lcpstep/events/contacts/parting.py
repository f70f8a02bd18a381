"""Contacts that the forces open between impacts of one instant, as kernels; see `events.parabolas.modes.let_go`.

Time goes on between two impacts, if by less than can be told: what has parted passes no impulse on until it strikes
again. So a plastic contact beside an elastic one, which the forces let go, comes to rest by ever closer impacts.
What joints lead along a surface parts from it, too, if it but touches it.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.contacts.equations import measure, renew_friction
from lcpstep.events.contacts.modes import decide
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import gap_tolerance, hold_modes
from lcpstep.events.rows.equations import acceleration_of
from lcpstep.events.rows.held import hold_joints
from lcpstep.events.rows.on_joints import is_led
from lcpstep.events.rows.problem import accelerate, accelerate_on_joints
from lcpstep.kernels.status import DONE
from lcpstep.pointers import abs, min


def part_before(s: Rubbing) -> None:
    """Mark the contacts that have opened so shortly before an impact that their speed is still but rounding."""
    hold_modes(s.rows)
    accelerate(s.rows)
    for c in range(s.n_c):
        i = s.n_j + c
        rises = s.mode[c] == OPEN and s.touches[c] == 1 and abs(s.velocity[i]) <= s.terms[c]
        s.parting[c] = 1 if rises and acceleration_of(s.rows, i, s.a) > 0.0 else 0


def pass_by(s: Rubbing) -> None:
    """Let pass what joints lead along a surface that it touches by no more than errors of its gap.

    It goes u^2 / (2 alpha) deep. Its speed u counts for none: an impulse that ends it would turn back all of the
    motion, and where nothing of the normal is left there is none.
    """
    for c in range(s.n_c if s.n_j > 0 else 0):
        i, u = s.n_j + c, s.velocity[s.n_j + c]
        if s.mode[c] != OPEN or s.touches[c] == 0 or u >= -s.terms[c]:
            continue
        hold_joints(s.rows)
        if not is_led(s.rows, c):
            continue
        accelerate_on_joints(s.rows)
        alpha = acceleration_of(s.rows, i, s.a)
        if alpha > 0.0 and u * u <= 2.0 * alpha * gap_tolerance(s.rows, c):
            s.terms[c], s.parting[c] = -u, 1


def let_go(s: Rubbing) -> bool:
    """Open the contacts that the forces open, where one has landed at this instant; False where not finite."""
    landed = False
    for c in range(s.n_c):
        new = s.mode[c] != OPEN and s.was_mode[c] == OPEN
        landed = landed or (new and s.instant[c] > 0.0)
    if not landed:
        return True
    if not measure(s, s.rows.t0, s.y):
        return False
    if decide(s) == DONE:
        for c in range(s.n_c):
            if s.mode[c] != OPEN and s.new_mode[c] == OPEN:
                s.mode[c], s.parting[c] = OPEN, 1
    return renew_friction(s)


def rejoin(s: Rubbing) -> None:
    """After the last impact of an instant the forces decide anew about the contacts that parted and still touch."""
    for c in range(s.n_c):
        if s.parting[c] == 1 and s.mode[c] == OPEN and abs(s.velocity[s.n_j + c]) <= s.terms[c]:
            s.mode[c] = SLIDES
        s.parting[c] = 0


def close_or_find_approach(s: Rubbing) -> bool:
    """Whether a contact on its surface approaches it; one there without speed to rounding is closed.

    By the law u + r u- < 0 of what has come to its surface at a corner, beyond which it may move away.
    """
    hit = False
    for c in range(s.n_c):
        u = s.velocity[s.n_j + c]
        if s.mode[c] == OPEN and s.touches[c] == 1:
            at_corner = s.jumped[c] != 0.0 and not s.in_turn
            back = s.model.restitution[c] * min(u - s.jumped[c], 0.0) if at_corner else 0.0
            strikes = u + back < -s.terms[c]
            hit = hit or strikes
            if abs(u) <= s.terms[c] and s.parting[c] == 0 and not strikes:
                s.mode[c] = SLIDES
    return hit
