"""The equations of a motion with friction at one state, called from Python: field, derivative, rows, guards, forces.

The same functions as those of the loop, so that what walks along a finished run (derivatives, balances) sees the same
mechanics; modes are those that `hold` is given, or that a run has found.
"""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

from lcpstep.events.friction.codes import OPEN, RELATIVE_STEP, SLIDES
from lcpstep.kernels.status import DONE, NOT_FINITE

if not cython.compiled:
    from lcpstep.arrays import doubles
    from lcpstep.events.friction.equations import free_motion, measure, measure_rows
    from lcpstep.events.friction.guards import look
    from lcpstep.events.friction.held import hold_modes, pull, right_hand_side
    from lcpstep.events.friction.impact import find_free
    from lcpstep.events.friction.modes import adopt_modes, decide
    from lcpstep.events.friction.state import GUARDS, Rubbing
    from lcpstep.kernels.vectors import copy
    from lcpstep.pointers import Doubles, abs, after, max, whole


def modes(s: Any) -> tuple[Any, Any]:
    """Modes and directions of the contacts, (n_c,) each."""
    n = s.n_c
    mode, direction = np.zeros(n), np.zeros(n)
    read_modes(s, doubles(mode), doubles(direction))
    return mode.astype(int), direction


def read_modes(s: Rubbing, mode: Doubles, direction: Doubles) -> None:
    """`modes`, into these."""
    for c in range(s.n_c):
        mode[c], direction[c] = s.mode[c], s.direction[c]


def settle(s: Any, t: float, x: Any, closed: Any) -> int:
    """Find and hold the modes of the contacts that are closed at the state x = (q, v); a status."""
    kinds = np.array(closed, dtype=float)
    return find_modes(s, t, doubles(x), doubles(kinds))


def find_modes(s: Rubbing, t: float, y: Doubles, closed: Doubles) -> int:
    """`settle`, of kernels' arrays."""
    s.clock.find_corners(t)
    copy(s.y, y, 2 * s.n_q)
    for c in range(s.n_c):
        s.mode[c] = SLIDES if closed[c] > 0.0 else OPEN
        s.touches[c] = 1 if closed[c] > 0.0 else 0
    if not measure(s, t, s.y):
        return NOT_FINITE
    find_free(s)
    code = decide(s)
    return adopt_modes(s) if code == DONE else code


def hold(s: Any, t: float, x: Any, mode: Any, direction: Any) -> bool:
    """Hold the rows of these modes from the state x = (q, v) on; False where no forces do."""
    kinds, ways = np.array(mode, dtype=float), np.array(direction, dtype=float)
    return begin_modes(s, t, doubles(x), doubles(kinds), doubles(ways))


def begin_modes(s: Rubbing, t: float, y: Doubles, mode: Doubles, direction: Doubles) -> bool:
    """`hold`, of kernels' arrays."""
    s.clock.find_corners(t)
    for c in range(s.n_c):
        s.mode[c], s.direction[c] = whole(mode[c]), direction[c]
        s.loaded[c] = 1 if s.mode[c] != OPEN else 0
    if not free_motion(s, t, y, s.a_free):
        return False
    return measure_rows(s, t, y) and hold_modes(s)


def field(s: Any, t: float, x: Any) -> Any:
    """(v, v') with the rows held, (2 n_q,)."""
    dy = np.zeros(2 * s.n_q)
    right_hand_side(s, t, doubles(x), doubles(dy))
    return dy


def slopes(s: Any, t: float, x: Any) -> Any:
    """Derivative of `field` by x, (2 n_q, 2 n_q)."""
    n = 2 * s.n_q
    A, y, dy = np.zeros((n, n)), np.array(x), np.zeros(n)
    difference(s, t, doubles(y), doubles(dy), doubles(A))
    return A


def difference(s: Rubbing, t: float, y: Doubles, dy: Doubles, A: Doubles) -> None:
    """A <- the derivative of the field, by differences of fourth order."""
    n = 2 * s.n_q
    for j in range(n):
        x, d = y[j], RELATIVE_STEP * max(1.0, abs(y[j]))
        for k in range(4):
            place = k - 2 if k < 2 else k - 1  # -2, -1, 1, 2
            weight = (8.0 if abs(place) == 1 else -1.0) * (1.0 if place > 0 else -1.0) / (12.0 * d)
            y[j] = x + place * d
            right_hand_side(s, t, y, dy)
            for i in range(n):
                A[i * n + j] += weight * dy[i]
        y[j] = x


def guards(s: Any, t: float, x: Any) -> Any:
    """What ends the modes, (n_c, 3), see `events.friction.guards`."""
    out = np.zeros((s.n_c, GUARDS))
    write_guards(s, t, doubles(x), doubles(out))
    return out


def write_guards(s: Rubbing, t: float, y: Doubles, out: Doubles) -> None:
    """`guards`, into out."""
    look(s, t, y)
    for g in range(GUARDS * s.n_c):
        out[g] = s.value[g]


def forces(s: Any, t: float, x: Any) -> Any:
    """Forces of joints, normals and tangents under the modes held, (n_j + 2 n_c,)."""
    out, dy = np.zeros(s.n_r), np.zeros(2 * s.n_q)
    write_forces(s, t, doubles(x), doubles(dy), doubles(out))
    return out


def write_forces(s: Rubbing, t: float, y: Doubles, dy: Doubles, out: Doubles) -> None:
    """`forces`, into out."""
    right_hand_side(s, t, y, dy)
    for i in range(s.n_r):
        out[i] = s.multiplier[i]


def pulls(s: Any) -> Any:
    """Friction that comes with each normal force under the modes held, (n_c,): -s mu of a contact that slides."""
    out = np.zeros(s.n_c)
    write_pulls(s, doubles(out))
    return out


def write_pulls(s: Rubbing, out: Doubles) -> None:
    """`pulls`, into out."""
    for c in range(s.n_c):
        out[c] = pull(s, s.n_j + c)


def rows(s: Any, t: float, x: Any) -> Any:
    """Rows R, M^-1 R^T (n_r, n_q) of joints, normals and tangents, rates and gaps (n_r,); x = (q, v)."""
    n, r = s.n_q, s.n_r
    out = np.zeros(2 * r * n + 2 * r)
    write_rows(s, t, doubles(x), doubles(out))
    R, MR = out[: 2 * r * n].reshape(2, r, n)
    return R, MR, out[2 * r * n : -r], out[-r:]


def write_rows(s: Rubbing, t: float, y: Doubles, out: Doubles) -> None:
    """`rows`, into out."""
    if s.clock.low > s.clock.high:  # nothing has been held yet
        s.clock.find_corners(t)
    measure(s, t, y)
    n, r = s.n_q, s.n_r
    for k in range(r * n):
        out[k], out[r * n + k] = s.R[k], s.MR[k]
    tail = after(out, 2 * r * n)
    for i in range(r):
        tail[i], tail[r + i] = s.rate[i], s.gap[i]
