"""Contacts at which forces balance, as kernels: which of them stay closed.

Where a contact force is about to begin, or to end, the forces beside it cancel, and what is left of their sum is
rounding. How large that is the sum does not tell, nor does a force that is a function of the state. But forces that
balance do so for a moment: an acceleration that is nothing beside what it will be in a moment says nothing.
"""

from __future__ import annotations

import cython

from lcpstep.events.general.ends import NO_FORCES
from lcpstep.kernels.status import DONE, NOT_FINITE

if not cython.compiled:
    from lcpstep.events.general.equations import measure, measure_again
    from lcpstep.events.general.forces import contact_forces
    from lcpstep.events.general.held import accelerate
    from lcpstep.events.general.state import Mechanism
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import abs, after, min

MOMENT = 1e-4  # of the next step
DOUBTFUL = 10.0  # of what an acceleration changes by in a moment: larger ones are no rounding


def balanced_forces(s: Mechanism, t: float) -> int:
    """`contact_forces`, but a contact opens, or asks for a force, only by an acceleration that is known.

    One that is kept closed wrongly has a negative multiplier in the next step, which opens it with a look ahead.
    """
    for c in range(s.n_c):
        s.kept[c] = s.contact.closed[c]
    code = contact_forces(s, t)
    opened, doubtful = code == NO_FORCES, code == NO_FORCES
    for c in range(s.n_c):
        opened = opened or opens(s, c)
    if code not in (DONE, NO_FORCES) or not opened:
        return code
    if not change_soon(s, t, MOMENT * min(s.smooth.next_step, s.scan)):
        return NOT_FINITE
    if code == NO_FORCES:
        for m in range(s.n_members):
            c = s.contact.member[m]
            if abs(s.contact.b[m]) > DOUBTFUL * s.left.curve[c]:
                return NO_FORCES
            s.contact.loaded[c] = 0
    for c in range(s.n_c):
        if opens(s, c) and s.contact.curve[c] <= DOUBTFUL * s.left.curve[c]:
            s.contact.closed[c], doubtful = 1, True
    if doubtful:
        accelerate(s)
    return DONE


def opens(s: Mechanism, c: int) -> bool:
    """Whether contact c was closed before the forces were sought."""
    return s.kept[c] == 1 and s.contact.closed[c] == 0


def change_soon(s: Mechanism, t: float, tau: float) -> bool:
    """What gap accelerations without contact forces change by from t to t + tau, into `left.curve`."""
    n, q, v, a = s.n_q, s.trial, after(s.trial, s.n_q), after(s.trial, 2 * s.n_q)
    copy(q, s.q, 2 * n)
    copy(a, s.a_free, n)
    for c in range(s.n_c):
        s.left.curve[c], s.left.gap[c], s.left.speed[c] = (
            s.contact.bias[c],
            s.contact.gap[c],
            s.contact.speed[c],
        )
    for j in range(n):
        s.q[j] += tau * v[j]
        s.v[j] += tau * s.a[j]
    known = measure(s, t + tau)
    for c in range(s.n_c):
        s.contact.gap[c], s.contact.speed[c] = s.left.gap[c], s.left.speed[c]
        change = abs(s.contact.bias[c] - s.left.curve[c])
        for j in range(n):
            change += abs(s.R[(s.n_j + c) * n + j] * (s.a_free[j] - a[j]))
        s.left.curve[c] = change
    copy(s.q, q, 2 * n)
    return known and measure_again(s, t)
