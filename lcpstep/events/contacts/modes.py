"""Which closed contacts stick, slide or open, as kernels: the complementarity problem of accelerations.

    0 <= alpha  complementary to  lambda_N >= 0,    lambda_T = -mu lambda_N sign(gamma)

gamma is the sliding velocity, or its rate where that is zero. For a contact that slides, lambda_N and alpha are one
linear complementarity problem whose matrix may fail to be positive: it has no answer then, or two (Painleve).

Sources: F. Pfeiffer, C. Glocker, Multibody Dynamics with Unilateral Contacts (Wiley 1996), chapter 6; F. Genot,
B. Brogliato, New results on Painleve paradoxes, European Journal of Mechanics A/Solids 18 (1999) 653.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import EDGE, LEANS, NO_FORCES, OPEN, SLIDES, STICKS
from lcpstep.events.contacts.bracing import brace
from lcpstep.events.contacts.equations import let_stick
from lcpstep.events.contacts.leaning import stand, stand_alone
from lcpstep.events.contacts.several import opened_or_closed
from lcpstep.events.contacts.state import Rubbing
from lcpstep.events.rows.contacts import hold_modes
from lcpstep.events.rows.equations import size_of_acceleration
from lcpstep.events.rows.keep import tell
from lcpstep.events.rows.on_joints import acceleration_on_joints, can_bear
from lcpstep.events.rows.problem import (
    accelerate_on_joints,
    fill,
    leave_independent,
    list_unknowns,
    row_of,
    solve_forces,
    stand_without_friction,
)
from lcpstep.kernels.clock import LEAST
from lcpstep.kernels.coulomb import motion_of
from lcpstep.kernels.repose import is_loaded, moves, stay
from lcpstep.kernels.roundings import NOISE
from lcpstep.kernels.status import DONE, PAINLEVE_INCONSISTENT, PAINLEVE_INDETERMINATE
from lcpstep.pointers import abs, max

# Of accelerations that hang together: as much solving for the forces leaves of one that is none
LEANING = 1e-12


def decide(s: Rubbing) -> int:
    """New modes of the closed contacts at the state just measured, in `new_mode` and `new_direction`; a status.

    `may_stick` says which contacts may: their sliding velocity is zero. The others slide as `direction` says.
    """
    for c in range(s.n_c):
        s.new_mode[c], s.new_direction[c], s.new_loaded[c] = OPEN, s.direction[c], 0
    accelerate_on_joints(s.rows)
    for c in range(s.n_c):
        s.problem.mu[c] = s.mu_s[c] if s.may_stick[c] == 1 else s.mu[c]
    begins = True
    while True:
        n_a, n_f = list_unknowns(s.rows)
        if n_a == 0:
            return DONE
        fill(s.rows, n_a, n_f)
        for a in range(n_a + n_f):
            rate = acceleration_on_joints(s.rows, row_of(s.rows, a, n_a), s.a)
            s.problem.rate[a] = rate if abs(rate) > LEAST else 0.0
        code = find_forces(s, n_a, n_f)
        if code == PAINLEVE_INCONSISTENT and begins and let_stick(s):
            continue
        if code != DONE:
            return code
        if begins and n_f > 1:
            rest_where_possible(s, n_a, n_f)
        begins = False
        if not (s.coefficients.two and begin_to_slide(s, n_a, n_f)):
            read_modes(s, n_a, n_f)
            if n_f == 0:
                leave_independent(s.rows, n_a, s.new_loaded)
            return DONE


def rest_where_possible(s: Rubbing, n_a: int, n_f: int) -> None:
    """Take forces that leave what is at rest there for those found, where there are such and these do not."""
    some = False
    for f in range(n_f):
        pressed = is_loaded(s.problem, s.problem.carrier[f], n_a, n_f)
        some = some or (pressed and moves(s.problem, s.problem.impulse, n_a + f, n_a + n_f))
    if some:
        for a in range(n_a):
            c = s.problem.ids[a]
            s.problem.sum[a] = 1.0 if s.may_stick[c] == 0 and s.coefficients.rough[c] == 1 else 0.0
        stay(s.problem, n_a, n_f)


def begin_to_slide(s: Rubbing, n_a: int, n_f: int) -> bool:
    """Give those that the forces found do not keep from sliding the coefficient of what slides; are there any?"""
    some = False
    for f in range(n_f):
        c = s.problem.ids[s.problem.carrier[f]]
        if s.problem.mu[c] != s.mu[c] and moves(s.problem, s.problem.impulse, n_a + f, n_a + n_f):
            s.problem.mu[c] = s.mu[c]
            some = True
    return some


def find_forces(s: Rubbing, n_a: int, n_f: int) -> int:
    """Solve; a sliding contact whose own mobility is not positive has no answer, or two; so may several together.

    `culprit` is the contact, -1 where several have no answer that would have one without friction.
    """
    m, jams = n_a + n_f, -1
    for a in range(n_a):
        c = s.problem.ids[a]
        if s.may_stick[c] == 0 and can_bear(s.rows, c) and s.problem.mobility[a * m + a] <= 0.0:
            jams = a
    if jams >= 0:
        s.rows.culprit = s.problem.ids[jams]
        if n_a == 1:
            return PAINLEVE_INCONSISTENT if s.problem.rate[0] < 0.0 else PAINLEVE_INDETERMINATE
    if not solve_forces(s.rows, n_a, n_f):
        s.rows.culprit = s.rows.culprit if jams >= 0 else -1
        return PAINLEVE_INCONSISTENT if jams >= 0 or stand_without_friction(s.rows, n_a) else NO_FORCES
    other = opened_or_closed(s.problem, n_a) if jams < 0 and n_f == 0 else -1
    if other >= 0:
        s.rows.culprit = s.problem.ids[other]
    return PAINLEVE_INDETERMINATE if jams >= 0 or other >= 0 else DONE


def read_modes(s: Rubbing, n_a: int, n_f: int) -> None:
    """Modes from the forces of the problem and the accelerations that they leave."""
    for a in range(n_a):
        c = s.problem.ids[a]
        if s.problem.impulse[a] > 0.0:
            s.new_loaded[c] = 1
            s.new_mode[c] = SLIDES
        elif not opens(s, a, n_a, n_f):
            s.new_mode[c] = SLIDES
    for f in range(n_f):
        k = s.problem.carrier[f]
        c, force, rate = s.problem.ids[k], s.problem.impulse[n_a + f], acceleration(s, n_a + f, n_a, n_f)
        limit = s.problem.mu[c] * s.problem.impulse[k]
        if s.new_mode[c] == OPEN:
            continue
        if limit > 0.0 and abs(force) < limit * (1.0 - EDGE):
            s.new_mode[c] = STICKS
        elif limit > 0.0:
            s.new_direction[c] = 1.0 if force < 0.0 else -1.0
            if is_still(s, n_a + f, rate, n_a, n_f):
                s.new_mode[c] = LEANS
            elif rate * s.new_direction[c] < 0.0:  # large forces have hidden that it does not slide
                s.new_mode[c] = STICKS
        elif is_still(s, n_a + f, rate, n_a, n_f) and is_loaded(s.problem, k, n_a, n_f):
            s.new_mode[c] = STICKS  # its share of the load begins at zero, as its friction does
        else:
            s.new_direction[c] = 1.0 if rate >= 0.0 else -1.0


def keep_mode(s: Rubbing, c: int) -> None:
    """Keep the mode at hand of contact c in the place of that decided."""
    s.new_mode[c], s.new_direction[c], s.new_loaded[c] = s.mode[c], s.direction[c], s.loaded[c]


def mark_undecided(s: Rubbing) -> bool:
    """Whether the forces leave the mode of a contact open, after `decide`: those that come decide about it.

    It has no normal force, and none would be needed. Where nothing pulls along it either it sticks meanwhile.
    """
    n_a, n_f = list_unknowns(s.rows)
    some = False
    for a in range(n_a):
        if idles(s, a, n_a, n_f):
            some = True
            s.new_loaded[s.problem.ids[a]] = 0
    for f in range(n_f):
        a, T = s.problem.carrier[f], n_a + f
        if idles(s, a, n_a, n_f) and is_nothing(s, T, acceleration(s, T, n_a, n_f), n_a, n_f):
            s.new_mode[s.problem.ids[a]] = STICKS
    return some


def idles(s: Rubbing, a: int, n_a: int, n_f: int) -> bool:
    """Whether the contact of unknown a has neither a normal force nor an acceleration, with it or without.

    One whose normal the joints hold never has: nothing decides about it.
    """
    if not can_bear(s.rows, s.problem.ids[a]):
        return False
    push = s.problem.mobility[a * (n_a + n_f) + a] * s.problem.impulse[a]
    free = is_nothing(s, a, s.problem.rate[a], n_a, n_f)
    return free and is_nothing(s, a, push, n_a, n_f) and not opens(s, a, n_a, n_f)


def is_nothing(s: Rubbing, a: int, alpha: float, n_a: int, n_f: int) -> bool:
    """Whether an acceleration of unknown a's row is zero as far as it is known."""
    return abs(alpha) <= NOISE * size_of_terms(s, a, n_a, n_f) + s.unsure[row_of(s.rows, a, n_a)]


def acceleration(s: Rubbing, a: int, n_a: int, n_f: int) -> float:
    """The acceleration of unknown a's row under the forces found."""
    return motion_of(s.problem, s.problem.impulse, a, n_a + n_f)[0]


def opens(s: Rubbing, a: int, n_a: int, n_f: int) -> bool:
    """Whether the contact of unknown a, which carries no force, accelerates away.

    By more than the rounding of forces that hang together: friction that has nothing to hold is that of the largest.
    """
    alpha, doubt = acceleration(s, a, n_a, n_f), s.unsure[row_of(s.rows, a, n_a)]
    if alpha <= NOISE * size_of_terms(s, a, n_a, n_f) + doubt:
        return False
    return alpha > NOISE * size_of_coupled(s, a, n_a, n_f) + doubt


def size_of_terms(s: Rubbing, a: int, n_a: int, n_f: int) -> float:
    """Size of the terms of the same acceleration, their signs left aside.

    Friction is known to the rounding of its limit, from which the solver measures it.
    """
    m, size = n_a + n_f, size_of_acceleration(s.rows, row_of(s.rows, a, n_a), s.a)
    for b in range(n_a):
        size += abs(s.problem.mobility[a * m + b] * s.problem.impulse[b])
    for f in range(n_f):
        k = s.problem.carrier[f]
        limit = s.problem.mu[s.problem.ids[k]] * s.problem.impulse[k]
        size += abs(s.problem.mobility[a * m + n_a + f] * max(limit, abs(s.problem.impulse[n_a + f])))
    return size


def is_still(s: Rubbing, a: int, rate: float, n_a: int, n_f: int) -> bool:
    """Whether an acceleration of unknown a's row is no more than what solving for the forces leaves of none."""
    return abs(rate) <= LEANING * size_of_coupled(s, a, n_a, n_f)


def size_of_coupled(s: Rubbing, a: int, n_a: int, n_f: int) -> float:
    """The largest size of terms among the accelerations that one hangs together with: joints share their rounding."""
    m, size = n_a + n_f, size_of_terms(s, a, n_a, n_f)
    for b in range(m):
        if s.problem.mobility[a * m + b] != 0.0:
            size = max(size, size_of_terms(s, b, n_a, n_f))
    return size


def obey(s: Rubbing) -> int:
    """Take over the modes decided, and hold their rows; log what has changed."""
    code = adopt_modes(s)
    if code == DONE:
        tell(s.rows)
    return code


def adopt_modes(s: Rubbing) -> int:
    """Take over the modes decided, and hold their rows, or others that carry the load where these do not."""
    take_over_modes(s)
    stands = hold_modes(s.rows)
    if stands and not brace(s):
        take_over_modes(s)
        stands = hold_modes(s.rows)
    return DONE if stands else PAINLEVE_INCONSISTENT


def take_over_modes(s: Rubbing) -> None:
    """The modes decided; what leans on others sticks where these, or nothing but it, can carry it."""
    leaning, s.sharing = 0, False
    for c in range(s.n_c):
        s.mode[c], s.direction[c], s.loaded[c] = s.new_mode[c], s.new_direction[c], s.new_loaded[c]
        s.touches[c] = 1 if s.mode[c] != OPEN else s.touches[c]
        leaning += s.mode[c] == LEANS
    if leaning > 0 and not stand(s):
        stand_alone(s)
