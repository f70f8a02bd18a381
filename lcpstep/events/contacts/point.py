"""The equations of a motion with contacts at one state, called from Python: field, rows, guards, forces.

The same functions as those of the loop, so that what walks along a finished run (derivatives, balances) sees the same
mechanics; modes are those that `hold` is given, or that a run has found.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.arrays import doubles
from lcpstep.events.codes import OPEN, SLIDES
from lcpstep.events.contacts.equations import measure, measure_rows
from lcpstep.events.contacts.guards import look
from lcpstep.events.contacts.held import right_hand_side
from lcpstep.events.contacts.impact import find_who_may_stick
from lcpstep.events.contacts.modes import adopt_modes, decide
from lcpstep.events.contacts.state import GUARDS, Rubbing
from lcpstep.events.rows.contacts import friction_ratio, hold_modes
from lcpstep.events.rows.equations import free_motion
from lcpstep.kernels.status import DONE, NOT_FINITE
from lcpstep.kernels.vectors import copy


@cython.ccall
def modes(s: Rubbing) -> tuple[Any, Any]:
    """Modes and directions of the contacts, (n_c,) each."""
    mode, direction = np.zeros(s.n_c, dtype=int), np.zeros(s.n_c)
    for c in range(s.n_c):
        mode[c], direction[c] = s.mode[c], s.direction[c]
    return mode, direction


@cython.ccall
def settle(s: Rubbing, t: float, x: Any, closed: Any) -> int:
    """Find and hold the modes of the contacts that are closed at the state x = (q, v); a status."""
    s.rows.find_corners(t)
    copy(s.y, doubles(x), 2 * s.n_q)
    for c in range(s.n_c):
        s.mode[c] = SLIDES if closed[c] else OPEN
        s.touches[c] = 1 if closed[c] else 0
    if not measure(s, t, s.y):
        return NOT_FINITE
    find_who_may_stick(s)
    code = decide(s)
    return adopt_modes(s) if code == DONE else code


@cython.ccall
def hold(s: Rubbing, t: float, x: Any, mode: Any, direction: Any) -> bool:
    """Hold the rows of these modes from the state x = (q, v) on; False where no forces do."""
    s.rows.find_corners(t)
    for c in range(s.n_c):
        s.mode[c], s.direction[c] = int(mode[c]), direction[c]
        s.loaded[c] = 1 if s.mode[c] != OPEN else 0
    y = doubles(x)
    if not free_motion(s.rows, t, y, s.a_free):
        return False
    return measure_rows(s, t, y) and hold_modes(s.rows)


@cython.ccall
def field(s: Rubbing, t: float, x: Any) -> Any:
    """(v, v') with the rows held, (2 n_q,)."""
    dy = np.zeros(2 * s.n_q)
    right_hand_side(s, t, doubles(x), doubles(dy))
    return dy


@cython.ccall
def guards(s: Rubbing, t: float, x: Any) -> Any:
    """What ends the modes, (n_c, 3), see `events.contacts.guards`."""
    out = np.zeros((s.n_c, GUARDS))
    look(s, t, doubles(x))
    copy(doubles(out), s.value, GUARDS * s.n_c)
    return out


@cython.ccall
def forces(s: Rubbing, t: float, x: Any) -> Any:
    """Forces of joints, normals and tangents under the modes held, (n_j + 2 n_c,)."""
    out, dy = np.zeros(s.n_r), np.zeros(2 * s.n_q)
    right_hand_side(s, t, doubles(x), doubles(dy))
    copy(doubles(out), s.multiplier, s.n_r)
    return out


@cython.ccall
def pulls(s: Rubbing) -> Any:
    """Friction that comes with each normal force under the modes held, (n_c,): -s mu of a contact that slides."""
    return np.array([friction_ratio(s.rows, s.n_j + c) for c in range(s.n_c)])


@cython.ccall
def rows(s: Rubbing, t: float, x: Any) -> Any:
    """Rows R, M^-1 R^T (n_r, n_q) of joints, normals and tangents, rates and gaps (n_r,); x = (q, v)."""
    if s.rows.low > s.rows.high:  # nothing has been held yet
        s.rows.find_corners(t)
    measure(s, t, doubles(x))
    n, r = s.n_q, s.n_r
    R, MR = np.zeros((2, r, n))
    rate, gap = np.zeros((2, r))
    copy(doubles(R), s.R, r * n)
    copy(doubles(MR), s.MR, r * n)
    copy(doubles(rate), s.rate, r)
    copy(doubles(gap), s.gap, r)
    return R, MR, rate, gap
