"""Contacts whose hops no longer matter are closed, as kernels; see `events.rows.chatter`."""

from __future__ import annotations

import cython

from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.parabolas.state import Mechanism
from lcpstep.events.rows.chatter import disturbs, find_over, take_along, tell_over
from lcpstep.events.rows.held import is_held, solve_held
from lcpstep.events.rows.keep import put_on_account
from lcpstep.kernels.vectors import clear


def close_chatter(s: Mechanism) -> bool:
    """Close the contacts whose further impacts stay below the tolerance; whether there was one."""
    if not find_over(s):
        return False
    take_along(s)
    if disturbs(s):
        return False
    for c in range(s.n_c):
        if s.left[c] >= 0.0:
            tell_over(s, c)
            s.mode[c], s.gap[s.n_j + c] = SLIDES, 0.0
    s.halt()
    clear(s.multiplier, s.n_r)
    for m in range(s.n_held):
        s.multiplier[s.row[m]] = s.change[m]
    put_on_account(s)
    return True


def hand_on(s: Mechanism) -> None:
    """What a closed contact still owes goes to the rows held, if it is none: R_c = sum y_m R_m, they bear its force.

    Where y_m < 0 row m has a claim instead, at once. The rows held must be those of the forces just found.
    """
    n_j = s.n_j
    for c in range(s.n_c):
        p = s.impulse[c] + s.owed[c]
        if s.owed[c] < 0.0 and p < 0.0 and s.mode[c] != OPEN and not is_held(s, n_j + c):
            for m in range(s.n_held):
                s.change[m] = s.D[s.row[m] * s.n_r + n_j + c]
            solve_held(s, s.change)
            for m in range(s.n_held):
                share, i = p * s.change[m], s.row[m]
                d = i - n_j
                if i < n_j:
                    s.impulse[s.n_c + i] = s.impulse[s.n_c + i] + share
                elif share > 0.0:
                    s.impulse[d] = s.impulse[d] + share
                else:
                    s.owed[d] = s.owed[d] + share
            s.impulse[c] = s.owed[c] = 0.0
