"""Contacts that close at one instant, as far as rounding tells: whether they strike together, or one after the other.

Impacts in turn,    u+ = -r u of the one that strikes,    u + W_cd p of the other,

leave other speeds where the other one is first, but for elastic bodies of one mass. Source: Newton's law of impact,
as in `events.parabolas.impact`.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.dynamics import moves
from lcpstep.kernels.model import Model
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.vectors import size_of_product
from lcpstep.pointers import Doubles, abs, min

CROSSED = 1000.0  # roundings of a gap: so far off a contact may be while another one crosses its own
SAME_OUTCOME, TURNS = 1e-10, 64  # of impacts in turn: relative difference of speeds; impacts of each contact


def gap_rounding(m: Model, G: Doubles, q: Doubles, c: int, path: float) -> float:
    """What rounding may leave of gap c where it is closed: of its terms, and of the way by which it has come.

    Of contacts whose gaps are as small at one instant it is not known which came first; where that matters
    (`order_matters`) they strike together. A moving obstacle's place must be known (`gaps`).
    """
    size = path
    if m.flat:
        size += abs(m.offset[c])
        if moves(m):
            size += abs(m.motion_now[3 * c])
    return NOISE * (size + size_of_product(G, q, c, m.n_q))


def moment_untold(rounding: float, u: float, since: float) -> float:
    """For how long it is not known when a gap has closed that does so with u < 0, as long after its last impact.

    A slow one crosses its rounding in long; in a hop it is known to digits of its own.
    """
    return min(rounding / -u, NOISE * since)


def order_matters(
    W_c: float, W_d: float, W_cd: float, r_c: float, r_d: float, u_c: float, u_d: float
) -> bool:
    """Whether the impacts of two contacts, taken in turn, leave other speeds where the other one is first.

    It does not for elastic bodies of one mass that meet, which exchange their speeds; it does for most.
    """
    if W_cd == 0.0:
        return False
    c, d = in_turn(W_c, W_d, W_cd, r_c, r_d, u_c, u_d)
    other_d, other_c = in_turn(W_d, W_c, W_cd, r_d, r_c, u_d, u_c)
    return abs(c - other_c) + abs(d - other_d) > SAME_OUTCOME * (abs(u_c) + abs(u_d))


def in_turn(
    W_c: float, W_d: float, W_cd: float, r_c: float, r_d: float, u_c: float, u_d: float
) -> tuple[float, float]:
    """Speeds after the impacts of two contacts in turn, the first one's at first."""
    slow = SAME_OUTCOME * (abs(u_c) + abs(u_d))
    for _ in range(TURNS):
        if u_c < -slow:
            p = -(1.0 + r_c) * u_c / W_c
            u_c, u_d = -r_c * u_c, u_d + W_cd * p
        if not u_d < -slow:
            break
        p = -(1.0 + r_d) * u_d / W_d
        u_d, u_c = -r_d * u_d, u_c + W_cd * p
        if not u_c < -slow:
            break
    return u_c, u_d
