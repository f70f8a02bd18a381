"""The blows of a step: all its contacts at once, or, where some separate while others strike, one after another.

A contact that was struck a step ago may still be predicted as closed though it separates, for it has been entered by
O(h). The law of a blow, 0 <= u+ + r u, is one for contacts that do not separate before it: with u > 0 it would let
another contact's blow push it back at up to r u unstruck. Where a contact strikes, closing faster than the forces of
the step could move it, those that separate as fast have no part in the blow. What it makes approach again strikes
next, still in the step, by the same law from the velocities at hand:

    0 <= u+ + r u  complementary to  p >= 0   on the active contacts that do not separate,     u+ = u + W p

until no active contact approaches any more. Blows that ever halve what is left end in a plastic one of all contacts,
and so do those that lose energy and go on with the speeds that they had before, as obstacles that close in feed them
(where these leave no room there is none), or go on for too long, as of a light body between heavy ones: else these
would pass through one another. Elastic ones that do so go on in the next step.
No blow raises the energy, and none of them waits for a step of its own, in which bodies would move on.

Source: the same sequence of problems as of impacts at one instant in `events.parabolas.modes`, `jump`.
"""

from __future__ import annotations

import cython

from lcpstep.kernels.model import Model
from lcpstep.kernels.recurrence import looks_back
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.kernels.status import DONE
from lcpstep.kernels.vectors import add, clear, copy, copy_indices, largest, product, size_of_product
from lcpstep.pointers import abs, after, max, min
from lcpstep.stepping.steps import LEFT, RETURNED, TURNS
from lcpstep.stepping.theta_method.codes import NEED_LCP
from lcpstep.stepping.theta_method.moving import Blows, Plan, Rows, State
from lcpstep.stepping.theta_method.responses import prepare
from lcpstep.stepping.theta_method.row_impulses import forced, impulses, pose, take_part


def separates(plan: Plan, s: State, c: Rows, b: Blows, n_a: int) -> bool:
    """Whether a contact separates while another strikes: then the sequence of blows that follow begins."""
    ids, opens, closes = c.problem.ids, 0.0, 0.0
    for k in range(n_a):
        opens, closes = max(opens, s.u[ids[k]]), max(closes, -s.u[ids[k]])
    if not (opens > 0.0 and closes > 0.0):
        return False
    size_v, b.slow = max(largest(s.v, 0.0, s.n_q), largest(s.v_free, 0.0, s.n_q)), b.least
    for k in range(n_a):
        rate = product(c.H, s.v_free, ids[k], s.n_q) + c.H_t[ids[k]]
        # A step does not show what moves the coordinates by no more than their rounding
        unmoved = RESOLUTION * size_of_product(c.H, s.q, ids[k], s.n_q) / plan.h
        b.slow = max(b.slow, forced(s, c, ids[k], rate, size_v) + unmoved)
        if b.slow >= min(opens, closes):
            return False
    copy_indices(b.ids, ids, n_a)
    clear(b.p, c.n)
    b.n_a, b.taken, b.last, b.ends, b.fastest = n_a, 0, False, False, 0.0
    return True


def one_after_another(m: Model, plan: Plan, s: State, c: Rows, b: Blows, t_next: float) -> int:
    """Blow after blow until nothing approaches; then all active contacts take part again, with all their impulses."""
    if not c.solved:
        prepare(m, plan, s, c, s.active, t_next)
    while c.solved or choose(s, c, b):
        code = impulses(m, plan, s, c, s.active, t_next, not b.last)
        if code == NEED_LCP:
            return code
        c.solved = False
        if code != DONE:
            all_of_them(s, c, b)
            return code
        add(b.p, 1.0, c.p, c.n)
        after_blow(plan, s, c, b)
        look_back(m, c, b)
    all_of_them(s, c, b)
    pose(m, plan, s, c, s.active, t_next, True)  # for `note_sticking`, of all rows again
    copy(c.p, b.p, c.n)
    for k in range(s.active + c.n_f):
        c.problem.impulse[k] = c.p[c.problem.ids[k]]
    return DONE


def choose(s: State, c: Rows, b: Blows) -> bool:
    """Contacts of the next blow: the active ones that do not separate; False where none of them strikes."""
    n, fastest = 0, 0.0
    for k in range(b.n_a):
        fastest = max(fastest, -b.u[b.ids[k]])
    if b.last or fastest <= b.slow or b.taken >= TURNS * b.n_a:
        return False
    b.fastest = max(b.fastest, fastest)
    b.last = b.ends or fastest <= LEFT * b.fastest
    for k in range(b.n_a):
        if b.last or b.u[b.ids[k]] <= b.slow:
            c.problem.ids[n] = b.ids[k]
            n += 1
    s.active = n
    take_part(c, n)
    return True


def look_back(m: Model, c: Rows, b: Blows) -> None:
    """Where blows go on without end, back at speeds of before or too many, let none follow, or but a plastic one.

    Light bodies between heavy ones that close in strike them a million times.
    """
    if b.last:
        return
    back, elastic = b.taken > 1, True
    for k in range(b.n_a):
        i = b.ids[k]
        back = back and abs(b.u[i] - b.u_before[i]) <= RETURNED * b.fastest
        elastic = elastic and m.restitution[i] == 1.0
    if back and elastic:
        b.taken = TURNS * b.n_a
    elif back or (b.taken == TURNS * b.n_a - 1 and not elastic):
        b.ends = True
    if looks_back(b.taken):
        copy(b.u_before, b.u, c.n_c)


def all_of_them(s: State, c: Rows, b: Blows) -> None:
    """All active contacts take part, and what was before the first blow is again."""
    b.begin(s, c)
    copy_indices(c.problem.ids, b.ids, b.n_a)
    s.active = b.n_a
    take_part(c, s.active)


def after_blow(plan: Plan, s: State, c: Rows, b: Blows) -> None:
    """Velocities after a blow, before the next."""
    n, n_k = s.n_q, s.active + c.n_f + c.n_j
    if b.taken == 0:
        copy(b.own_v, b.v, n)
    b.v, b.u, b.sliding = b.own_v, b.own_u, b.own_sliding
    for k in range(n_k):
        row = c.problem.ids[k]
        add(b.v, c.p[row], after(plan.X, row * n), n)
    for k in range(b.n_a):
        i = b.ids[k]
        b.u[i] = product(c.H, b.v, i, n) + c.H_t[i]
        if c.n_t > 0:
            b.sliding[i] = product(c.T, b.v, i, n) + c.T_t[i]
    b.taken += 1
