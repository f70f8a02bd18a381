"""Contacts that open where forces balance, as kernels: whether their accelerations are known.

Where forces cancel, what is left of their sum is rounding, and neither the sum nor a force given as a function says
how large that is. But forces that balance do so only for a moment. An acceleration that is nothing beside what it
will be in a moment decides nothing: the forces a little later do (`loop.look_on`). The moment is so short that a hop
within it cannot be told from rest.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, STICKS
from lcpstep.events.contacts.equations import force_noise, measure, share_left
from lcpstep.events.contacts.modes import adopt_modes, decide
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.contacts.surfaces import closed_below
from lcpstep.events.rows.equations import acceleration_of
from lcpstep.events.rows.problem import accelerate_as_held, accelerate_on_joints
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.kernels.vectors import clear, copy_indices
from lcpstep.pointers import abs, min

MOMENT, SHORTEST, SHORTER = 1e-4, 1e-9, 0.1  # of the next step; and how much shorter where a hop can be told
DOUBTFUL = 10.0  # of what an acceleration changes by in a moment: larger ones are no rounding


def opens_any(s: Rubbing) -> bool:
    """Whether a closed contact opens, by `decide`."""
    some = False
    for c in range(s.n_c):
        some = some or (s.mode[c] != OPEN and s.new_mode[c] == OPEN)
    return some


def changes_any(s: Rubbing) -> bool:
    """Whether `decide` opens a contact that now carries a force, or lets one slip that sticks."""
    some = False
    for c in range(s.n_c):
        some = some or lets_go(s, c)
    return some


def lets_go(s: Rubbing, c: int) -> bool:
    """Whether it does so with contact c."""
    opens, slips = s.new_mode[c] == OPEN, s.mode[c] == STICKS and s.new_mode[c] != STICKS
    return s.mode[c] != OPEN and s.loaded[c] == 1 and (opens or slips)


def reconsider(s: Rubbing, longest: float) -> int:
    """`decide` anew at the base state, with accelerations that are not known in `unsure`; a status.

    A contact opens only by an acceleration that is more than that. Where nothing is in doubt, `unsure` is zero.
    """
    h, share = min(s.next_step, longest), MOMENT
    while share >= SHORTEST:
        if not foresee(s, share * h):
            return NOT_FINITE
        if cannot_be_told(s, share * h):
            code = decide(s)
            if code != DONE or not pulls(s):
                return code
            break
        share *= SHORTER
    clear(s.unsure, s.n_r)
    return decide(s)


def pulls(s: Rubbing) -> bool:
    """Whether a contact that is closed in doubt would have to pull by more than the doubt.

    Walls that are nearly parallel take from two such forces, which cancel, what they hold in the little that is left.
    """
    copy_indices(s.tried, s.mode, s.n_c)
    some = adopt_modes(s) != DONE
    accelerate_as_held(s.rows)
    noise = force_noise(s)
    for c in range(s.n_c):
        i = s.n_j + c
        doubtful = s.mode[c] != OPEN and s.unsure[i] > 0.0 and s.W[i * s.n_r + i] > 0.0
        some = some or (doubtful and s.multiplier[i] < -noise - s.unsure[i] / s.W[i * s.n_r + i])
        s.mode[c] = s.tried[c]
    return some


def foresee(s: Rubbing, tau: float) -> bool:
    """What the accelerations of the rows, with joints alone, change by within the time tau, into `unsure`."""
    n = s.n_q
    accelerate_on_joints(s.rows)
    for i in range(s.n_r):
        s.unsure[i] = acceleration_of(s.rows, i, s.a)
    for j in range(n):
        s.seen[j] = s.q[j] + tau * s.v[j]
        s.seen[n + j] = s.v[j] + tau * s.a[j]
    if not measure(s, s.rows.t0 + tau, s.seen):
        return False
    accelerate_on_joints(s.rows)
    for i in range(s.n_r):
        s.unsure[i] = DOUBTFUL * abs(acceleration_of(s.rows, i, s.a) - s.unsure[i])
    return measure(s, s.rows.t0, s.y)


def cannot_be_told(s: Rubbing, tau: float) -> bool:
    """Whether the contacts that open rise no higher than rounding by an acceleration in doubt, while it is."""
    untold, long = True, DOUBTFUL * tau
    for c in range(s.n_c):
        if s.mode[c] != OPEN and s.new_mode[c] == OPEN:
            untold = untold and s.unsure[s.n_j + c] * long * long <= closed_below(s, c, share_left(s))
    return untold
