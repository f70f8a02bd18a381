"""When a guard acts that is known to act within a step: its root, by steps that end there, as kernels.

A force that jumps at a time that is no corner of the scene takes its guard through zero without a root: halving finds
the time, and the modes are decided by the force beyond it. Belts that jump: `events.rows.jumps`.
"""

from __future__ import annotations

import cython

from lcpstep.events.codes import SLIDES
from lcpstep.events.contacts.guards import look, look_at_stage
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.hybrid.locate import UNKNOWN
from lcpstep.events.rows.contacts import still_below
from lcpstep.kernels.dop853 import STAGES
from lcpstep.kernels.roundings import NOISE, RESOLUTION
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import abs, after, min

REFINEMENTS = 6  # of an event's time by repeated steps
FAR = 1e-3  # of a step: a guard that is off by so much is no polynomial, and secants lead astray
NEAR = 1e-5  # of a step: a way this short needs none, the trapezoidal rule leaves nothing of it but rounding


def locate(s: Rubbing, g: int, h: float, longest: float) -> float:
    """Time from now at which guard g acts: secants on steps of that length, of which the last one is left, complete.

    UNKNOWN where a state is not finite.
    """
    tau, change = min(s.found * h, longest), 0.0
    if tau <= 0.0:
        return 0.0
    for k in range(REFINEMENTS + 1):
        if not look_after(s, tau):
            return UNKNOWN
        change = missing(s, g)
        if abs(change) <= NEAR * tau or abs(change) > FAR * h or k == REFINEMENTS:
            break
        if tau + change <= 0.0:  # of so short a way the polynomial knows more than secants
            break
        tau = min(tau + change, longest)
    if not s.complete(s.rows.t0, tau):
        return UNKNOWN
    if abs(change) <= NEAR * tau:
        tau = creep(s, g, tau, change, longest)
    return close_in(s, g, tau, min(h, longest)) if tau != UNKNOWN and jumps(s, g, tau) else tau


def jumps(s: Rubbing, g: int, tau: float) -> bool:
    """Whether guard g is far from zero where its slope says that it is zero: a force has jumped, or a belt."""
    least = still_below(s.rows, s.n_j + s.n_c + g // GUARDS) if of_sliding(s, g) else s.band[g]
    return abs(s.value[g]) > least and abs(missing(s, g)) > NOISE * (abs(s.rows.t0) + tau)


def close_in(s: Rubbing, g: int, tau: float, longest: float) -> float:
    """The same by halving, down to the rounding of the time, just after the jump; where it has none, tau."""
    s.bracket.begin(0.0, longest, True, tau)
    s.bracket.halve(s.value[g] >= 0.0)
    if look_after(s, s.bracket.b) and s.value[g] < 0.0:
        while s.bracket.seek(2.0 * RESOLUTION * (abs(s.rows.t0) + s.bracket.b)):
            if not look_after(s, s.bracket.x):
                return UNKNOWN
            s.bracket.halve(s.value[g] >= 0.0)
        tau = s.bracket.b
    return tau if look_after(s, tau) and s.complete(s.rows.t0, tau) else UNKNOWN


def look_after(s: Rubbing, tau: float) -> bool:
    """A step of length tau, and all guards where it ends; False where a state is not finite."""
    return s.step(s.rows.t0, tau) and look_at_stage(s, STAGES, s.rows.t0 + tau, s.y_new)


def of_sliding(s: Rubbing, g: int) -> bool:
    """Whether guard g is a sliding velocity."""
    return s.mode[g // GUARDS] == SLIDES and g % GUARDS == 1


def missing(s: Rubbing, g: int) -> float:
    """How much later guard g acts than at the state last looked at."""
    return -s.value[g] / s.slope if s.slope < 0.0 and s.risen else 0.0


def creep(s: Rubbing, g: int, tau: float, change: float, longest: float) -> float:
    """Go on from the end of the step of length tau by the little that is missing; how far that is from the base.

    By less than a late time can tell, too: the clock keeps what rounding takes from it.
    """
    t, f, gone = s.rows.t0 + tau, after(s.K, STAGES * s.n), 0.0
    if abs(change) <= 2.0 * RESOLUTION * tau:
        return tau
    copy(s.y_stage, s.y_new, s.n)
    copy(s.dy, f, s.n)
    for k in range(REFINEMENTS):
        gone = min(gone + change, longest - tau)
        for i in range(s.n):
            s.y_new[i] = s.y_stage[i] + 0.5 * gone * (f[i] + s.dy[i])
        if not look(s, t + gone, s.y_new):
            return UNKNOWN
        change = missing(s, g)
        if k > 0 and abs(change) <= 2.0 * RESOLUTION * tau:
            break
        if abs(gone + change) > NEAR * tau:  # a force that but touches zero has no slope there
            break
    return tau + gone
