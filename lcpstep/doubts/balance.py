"""Whether the steps of a finished run lose or gain energy that no force accounts for.

    |sum of (T(end) - T(start) - W)| > share x (largest T + sum of |W|)    of steps, or of their ends after an event
     sum of (T(end) - T(start) - W)+  > share x (largest T + sum of |W|)    of steps up to an event, or over one

W is the work of the forces along the step (`kernels/surplus.py`); obstacles and joints that stand still do none.
Where steps resolve the motion the left side is below a hundredth of the right one; where they do not, as where a
mass turns with the place by radians in a step, energy comes or goes whatever the forces are, and nothing else tells;
likewise where a wall throws a body back just before a centre of attraction. Impacts may take energy and give none, so
that of steps with one what gains is told; with constant masses, since M' has no path over an impact.
Steps by a tolerance are not asked, nor those that take the forces of a linear system implicitly (see `periods`).
Explicit steps of order four grow without bound where damping takes more than 2.8 of a velocity in a step; along the
motion that force does not change, so that the frequencies of `resolution` do not tell it.
Source of the rule: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section IV.1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lagrangian import LinearContacts, LinearJoints, LinearSystem, System
from lcpstep.corner_times import corners_before
from lcpstep.doubts.depth import largest_energy
from lcpstep.trajectory import Trajectory

if TYPE_CHECKING:
    from lcpstep.kernels.model import Model

LOOKS = 32  # steps that are looked at first; all where these raise a doubt,
SUDDEN = 4  # or those that turned velocities most
SHARE = 0.05  # of the energy turned over
NEAR = 1e-3  # of a step: of the differences of M, and of the time of an event
STILL = 1e-6  # of the speed that forces alone would give within a step: that of a body at rest
ROUNDING = 1e-12  # of the coordinates, in a step: no motion


def unbalanced(run: Trajectory, m: Model, h: float) -> str:
    """How much energy steps h, of that model, lose or gain, in words; "" where they do not."""
    if not isinstance(run.scene.system, (System, LinearSystem)) or driven(run.scene.joints):
        return ""
    steps = np.arange(len(run.t) - 1)
    if len(steps) > LOOKS:
        times = len(steps) / LOOKS
        some = _surplus(run, m, h, (np.arange(LOOKS) * times).astype(int), times)
        if not (in_words(*some) or in_words(*_surplus(run, m, h, _sudden(run), 1.0))):
            return in_words(*_gain_at_impacts(run, m, h))
    # What some steps give and others take is no loss
    return in_words(*_surplus(run, m, h, steps, 1.0)) or in_words(*_gain_at_impacts(run, m, h))


def in_words(gained: float, turned_over: float) -> str:
    """That this is more of the energy than steps that resolve the motion would give or take; "" where it is not."""
    if abs(gained) <= SHARE * turned_over:
        return ""
    return (
        f"its steps {'gain' if gained > 0.0 else 'lose'} energy that no force accounts for, {abs(gained):.3g} J of "
        f"{turned_over:.3g} J in all: they are too long for this motion, and shorter ones change it"
    )


def _sudden(run: Trajectory) -> Any:
    """Of many kept states those after which velocities change most by forces, as where these have no bound."""
    change = np.max(np.abs(np.diff(run.v, axis=0)), axis=1)
    change[_struck(run)] = 0.0
    return np.sort(np.argpartition(change, -SUDDEN)[-SUDDEN:])


def _struck(run: Trajectory) -> Any:
    """Kept states between which and the next one an event lies; states asked for may end before the events."""
    k = np.unique(np.searchsorted(run.t, run.impacts.time)) - 1
    return k[(k >= 0) & (k < len(run.t) - 1)]


def _surplus(run: Trajectory, m: Model, h: float, k: Any, times: float) -> tuple[float, float]:
    """Energy without a source in all steps, and all that is turned over, where each of steps k stands for so many."""
    gained, work, kinetic = _between(run, m, h, _smooth(run, h, k), False)
    return times * gained, kinetic + times * work


def _gain_at_impacts(run: Trajectory, m: Model, h: float) -> tuple[float, float]:
    """Energy without a source in the steps with an impact that speed up most; their work, and the run's largest T."""
    contacts = run.scene.contacts
    if contacts is None or contacts.friction is not None or driven(contacts) or m.mass.given:
        return 0.0, 0.0
    if len(run.impacts) == 0:  # most short runs
        return 0.0, 0.0
    k = _struck(run)
    k = k[(run.t[k + 1] - run.t[k] < (1.0 + NEAR) * h) & ~_over_a_corner(run, h, k)]
    if len(k) == 0:
        return 0.0, 0.0
    speed = np.sum(run.v[k + 1] ** 2, axis=1) - np.sum(run.v[k] ** 2, axis=1)
    gained, work, _ = _between(run, m, h, k[np.argsort(speed)[-SUDDEN:]], True)
    return gained, largest_energy(run) + work


def _between(run: Trajectory, m: Model, h: float, k: Any, struck: bool) -> tuple[float, float, float]:
    """Of the steps from states k, with impacts or without: energy gained without a source, sum of |W|, largest T."""
    from lcpstep.kernels.surplus import surplus

    if len(k) == 0:
        return 0.0, 0.0, 0.0
    both = np.repeat(k, 2)
    both[1::2] += 1
    gained, work, kinetic, pushed, placed = surplus(
        m, run.t[both], run.q[both], run.v[both], NEAR * h, struck
    )
    if kinetic < (STILL * h) ** 2 * pushed + (ROUNDING / h) * (ROUNDING / h) * placed:
        return 0.0, 0.0, 0.0
    return gained, work, kinetic


def _over_a_corner(run: Trajectory, h: float, k: Any) -> Any:
    """Whether the steps from states k have a corner of the scene, so that forces at both ends tell nothing."""
    near = NEAR * h
    return corners_before(run.scene, run.t[k] - near) != corners_before(run.scene, run.t[k + 1] + near)


def driven(rows: Any) -> bool:
    """Whether contacts or joints move by themselves."""
    if rows is None:
        return False
    return (rows.motion if isinstance(rows, (LinearContacts, LinearJoints)) else rows.gap_t) is not None


def _smooth(run: Trajectory, h: float, k: Any) -> Any:
    """Of kept states k those from which a step leads to the next one without an event or work of a contact.

    Or the rest of a step, after an event that has a time of its own.
    """
    t, events, near = run.t, np.asarray(run.impacts)["time"], NEAR * h
    way = t[k + 1] - t[k]
    fits = np.abs(way - h) < near
    if len(events):  # states asked for within steps lie between those before and after a step
        fits &= np.searchsorted(events, t[k] - h - near) == np.searchsorted(events, t[k + 1] + h + near)
        last = np.searchsorted(events, t[k], side="right")
        after = (last > 0) & (events[last - 1] == t[k]) & (way < h)
        fits |= after & (last == np.searchsorted(events, t[k + 1] + near))
    fits &= ~_over_a_corner(run, h, k)
    contacts = run.scene.contacts
    if contacts is not None and (contacts.friction is not None or driven(contacts)):
        fits &= ~run.impulse[k + 1].any(axis=1)
    return k[fits]
