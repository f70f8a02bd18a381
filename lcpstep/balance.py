"""Whether the steps of a finished run lose or gain energy that no force accounts for.

    |sum of (T(end) - T(start) - W)| > share x (largest T + sum of |W|)            of steps without an event

W is the work of the forces along the step (`kernels/surplus.py`); obstacles and joints that stand still do none.
Where steps resolve the motion the left side is below a hundredth of the right one; where they do not, as where a
mass turns with the place by radians in a step, energy comes or goes whatever the forces are, and nothing else tells.
Steps by a tolerance are not asked, nor those that take the forces of a linear system implicitly. Explicit steps of
order four grow without bound where damping takes more than 2.8 of a velocity in a step; along the motion that force
does not change, so that the frequencies of `resolution` do not tell it.
Source of the rule: E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), section IV.1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from lagrangian import LinearContacts, LinearJoints, LinearSystem, System
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
        if not _too_much(*some) and not _too_much(*_surplus(run, m, h, _sudden(run), 1.0)):
            return ""
    gained, turned_over = _surplus(run, m, h, steps, 1.0)
    if not _too_much(gained, turned_over):  # what some steps give and others take is no loss
        return ""
    return (
        f"its steps {'gain' if gained > 0.0 else 'lose'} energy that no force accounts for, {abs(gained):.3g} J of "
        f"{turned_over:.3g} J in all: they are too long for this motion, and shorter ones change it"
    )


def _too_much(gained: float, turned_over: float) -> bool:
    """Whether that is more of the energy than steps that resolve the motion would give or take."""
    return abs(gained) > SHARE * turned_over


def _sudden(run: Trajectory) -> Any:
    """Of many kept states those after which velocities change most, as over a place where forces have no bound."""
    change = np.max(np.abs(np.diff(run.v, axis=0)), axis=1)
    return np.sort(np.argpartition(change, -SUDDEN)[-SUDDEN:])


def _surplus(run: Trajectory, m: Model, h: float, k: Any, times: float) -> tuple[float, float]:
    """Energy without a source in all steps, and all that is turned over, where each of steps k stands for so many."""
    from lcpstep.kernels.surplus import surplus

    k = _smooth(run, h, k)
    if len(k) == 0:
        return 0.0, 0.0
    both = np.column_stack([k, k + 1]).ravel()
    gained, work, kinetic, pushed, placed = surplus(m, run.t[both], run.q[both], run.v[both], NEAR * h)
    if kinetic < (STILL * h) ** 2 * pushed + (ROUNDING / h) * (ROUNDING / h) * placed:
        return 0.0, 0.0
    return times * gained, kinetic + times * work


def driven(rows: Any) -> bool:
    """Whether contacts or joints move by themselves."""
    if rows is None:
        return False
    return (rows.motion if isinstance(rows, (LinearContacts, LinearJoints)) else rows.gap_t) is not None


def _smooth(run: Trajectory, h: float, k: Any) -> Any:
    """Of kept states k those from which a step leads to the next one without an event or work of a contact."""
    t, events, near = run.t, run.impacts.time, NEAR * h
    way = t[k + 1] - t[k]
    fits = np.abs(way - h) < near
    if len(events):  # states asked for within steps lie between those before and after a step
        fits &= np.searchsorted(events, t[k] - h - near) == np.searchsorted(events, t[k + 1] + h + near)
    contacts = run.scene.contacts
    if contacts is not None and (contacts.friction is not None or driven(contacts)):
        fits &= ~run.impulse[k + 1].any(axis=1)
    return k[fits]
