"""Impacts without collision, as kernels: what ends sliding that has no force (Painleve's paradox).

Its force grows beyond all bounds: an impulse that presses the contact together until the sliding ends, and what
follows of the impact. By the laws that do not integrate it the normal has no restitution, as u- = 0. Of several
contacts that have no forces together none is the one that jams: their impulses are those of a step of the
theta-method in no time. Source: F. Genot, B. Brogliato, New results on Painleve paradoxes, European Journal of
Mechanics A/Solids 18 (1999) 653.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import JUMP, OPEN
from lcpstep.events.contacts.equations import measure
from lcpstep.events.contacts.impact import pose, strike_with
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.on_joints import acceleration_on_joints
from lcpstep.events.rows.problem import accelerate_on_joints, row_of
from lcpstep.kernels.coulomb import solve_contacts
from lcpstep.kernels.energetic import strike_in_turn
from lcpstep.kernels.status import BUFFER_FULL, DONE, NOT_FINITE, PAINLEVE_INCONSISTENT
from lcpstep.kernels.vectors import clear
from lcpstep.pointers import abs, inf, max

SHORT = 1e-11  # of the fastest sliding: what forces change in no time, a hundred times what impulses leave
LEFT = 1e-8  # the same: impulses that change less are those of forces


def jam(s: Rubbing) -> int:
    """The impact of the contact that jams (`culprit`), or of all that have no forces, at the base state; a status."""
    if not measure(s, s.rows.t0, s.y):
        return NOT_FINITE
    if s.rows.record.full(4 * s.n_c + 4):
        return BUFFER_FULL
    clear(s.instant, s.n_r)
    for c in range(s.n_c):
        s.before[c] = s.velocity[s.n_j + c] if s.mode[c] == OPEN else 0.0
        s.may_stick[c], s.touches[c] = 1, 1 if s.mode[c] != OPEN else 0
    accelerate_on_joints(s.rows)
    n_a, n_f = pose(s)
    hit = s.rows.culprit
    if hit < 0 or not jam_alone(s, hit, n_a, n_f):
        hit = s.n_c
        if not jam_together(s, n_a, n_f):
            return PAINLEVE_INCONSISTENT
    s.jams += 1
    strike_with(s, n_a, n_f, hit, False)
    clear(s.problem.slow, s.n_c)
    s.rows.next = JUMP
    return DONE


def jam_alone(s: Rubbing, hit: int, n_a: int, n_f: int) -> bool:
    """The impulses of the impact that contact `hit` begins; False where there are none."""
    first = -1
    for a in range(n_a):
        s.problem.rate[a] = 0.0
        s.problem.slow[a] = 0.0 if s.in_turn else inf
        if s.problem.ids[a] == hit:
            first = a
    for f in range(n_f):
        s.problem.rate[n_a + f] = slip_of(s, f)
    done = first >= 0 and strike_in_turn(s.problem, s.model.restitution, n_a, n_f, first)
    return done and s.problem.impulse[first] > 0.0


def jam_together(s: Rubbing, n_a: int, n_f: int) -> bool:
    """The impulses that end sliding which has no forces, those of the forces left out; False where there are none."""
    m, fastest, largest = n_a + n_f, 0.0, 0.0
    for f in range(n_f):
        fastest = max(fastest, abs(slip_of(s, f)))
    for a in range(m):
        s.problem.rate[a] = acceleration_on_joints(s.rows, row_of(s.rows, a, n_a), s.a)
        largest = max(largest, abs(s.problem.rate[a]))
    if s.in_turn or fastest == 0.0 or largest == 0.0:
        return False
    for a in range(m):
        slip = slip_of(s, a - n_a) if a >= n_a else 0.0
        s.problem.rate[a] = slip + SHORT * fastest / largest * s.problem.rate[a]
    if not solve_contacts(s.problem, n_a, n_f):
        return False
    some = False
    for a in range(n_a):
        if s.problem.mobility[a * m + a] * s.problem.impulse[a] <= LEFT * fastest:
            s.problem.impulse[a] = 0.0
        some = some or s.problem.impulse[a] != 0.0
    for f in range(n_f):
        if s.problem.impulse[s.problem.carrier[f]] == 0.0:
            s.problem.impulse[n_a + f] = 0.0
    for i in range(2 * s.n_c):
        s.terms[i] = max(s.terms[i], 2.0 * SHORT * fastest)
    return some


def slip_of(s: Rubbing, f: int) -> float:
    """The sliding velocity of unknown tangent f."""
    return s.velocity[s.n_j + s.n_c + s.problem.ids[s.problem.carrier[f]]]
