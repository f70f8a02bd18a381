"""Positions and velocities put onto the rows held, as kernels."""

from __future__ import annotations

import cython

from lcpstep.events.rows.equations import least_gap, list_gaps, measure_rates, respond_held
from lcpstep.events.rows.held import hold_again, measure_missing, push_by_change
from lcpstep.events.rows.state import Rows
from lcpstep.kernels.acceleration import factor_mass
from lcpstep.kernels.clock import LEAST
from lcpstep.kernels.dynamics import gaps
from lcpstep.kernels.vectors import add, clear, finite, largest
from lcpstep.pointers import Doubles, abs, after, inf

FEW, MOST = 2, 50  # of Newton's iterations
HELPS = 0.25  # of a gap: what an iteration may leave of it without new rows
CLOSED, TOLERANCES = 1e-3, 8.0  # of the tolerance: gaps that are none, and what others may leave


def project(s: Rows, t: float, y: Doubles) -> bool:
    """Put y = (q, v) onto the rows held, against the drift of the integration: gaps and velocities zero.

    The impulses that take the velocities are left in `change`; False where rows have become dependent.
    """
    for _ in range(FEW):
        if not are_open(s, t, y) or not take_rows(s, t, y):
            break
        push_by_change(s, y)
    if not take_rows(s, t, y):
        return False
    push_onto_rows(s, after(y, s.n_q))
    return True


def put_on_rows(s: Rows, t: float, y: Doubles) -> bool:
    """Put q onto the rows held, along the ways of those at hand while these help; False where no place is found.

    By Newton's method; what has pushed is left in `held`. Of a gap that is no number nor is the position.
    """
    before, anew = inf, False
    clear(s.held, s.n_held)
    for k in range(MOST):
        if not are_open(s, t, y) or (k > 0 and none_open(s, y, CLOSED)):
            return True
        if k == 0 and not finite(s.change, s.n_held):
            push_by_change(s, y)
            return True
        worst = largest(s.change, 0.0, s.n_held)
        helps = worst < HELPS * before
        if anew and not helps:
            return none_open(s, y, TOLERANCES)
        anew = not helps
        if anew and not take_rows(s, t, y):
            return False
        push_by_change(s, y)
        add(s.held, 1.0, s.change, s.n_held)
        before = worst
    return False


def push_onto_rows(s: Rows, v: Doubles) -> None:
    """Put v onto the rows held, which are those of its state, by impulses that are left in `change`.

    What remains of velocities that die away along them comes to rest while its rounding can be told from none.
    """
    measure_missing(s, v, s.rate)
    push_by_change(s, v)
    for j in range(s.n_q):
        if abs(v[j]) < LEAST:
            v[j] = 0.0


def are_open(s: Rows, t: float, y: Doubles) -> bool:
    """Whether gaps of rows held are not exactly zero, as what is no number; with signs turned, into `change`."""
    if s.n_held > s.n_kept:
        list_gaps(s, t, y, s.near)
    else:
        gaps(s.joints, t, y, after(y, s.n_q), s.near)
    for m in range(s.n_held):
        s.change[m] = -s.near[s.row[m]] if s.row[m] < s.n_j + s.n_c else 0.0  # tangents have none
    return largest(s.change, 0.0, s.n_held) > 0.0 or not finite(s.change, s.n_held)


def none_open(s: Rows, q: Doubles, tolerances: float) -> bool:
    """Whether the gaps just listed take no more than that of the tolerance from any coordinate."""
    none = True
    for m in range(s.n_held):
        none = none and abs(s.change[m]) <= tolerances * least_gap(s, s.row[m], q)
    return none


def take_rows(s: Rows, t: float, y: Doubles) -> bool:
    """Rows, rates and factors of the rows held at this state; False where these have become dependent."""
    if s.known:
        measure_rates(s, t, y)
        return True
    if not factor_mass(s.model, s.inside(t), y, after(y, s.n_q), s.M):
        return False
    measure_rates(s, t, y)
    respond_held(s)
    return hold_again(s) < 0
