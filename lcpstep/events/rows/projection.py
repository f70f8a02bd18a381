"""Positions and velocities put onto the rows held, as kernels."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.rows.equations import list_gaps
    from lcpstep.events.rows.held import measure_missing, push_by_change, renew_held
    from lcpstep.events.rows.state import Rows
    from lcpstep.kernels.acceleration import factor_mass
    from lcpstep.kernels.vectors import largest
    from lcpstep.pointers import Doubles


def project(s: Rows, t: float, q: Doubles, v: Doubles) -> bool:
    """Put q, v onto the rows held, against the drift of the integration: gaps and velocities zero.

    The impulses that take the velocities are left in `change`; False where rows have become dependent.
    """
    for _ in range(2):
        if not are_open(s, t, q, v) or not take_rows(s, t, q, v):
            break
        push_by_change(s, q)
    if not take_rows(s, t, q, v):
        return False
    measure_missing(s, v, s.rate)
    push_by_change(s, v)
    return True


def are_open(s: Rows, t: float, q: Doubles, v: Doubles) -> bool:
    """Whether gaps of rows held are not exactly zero; these, with their signs turned, into `change`."""
    list_gaps(s, t, q, v)
    for m in range(s.n_held):
        s.change[m] = -s.near[s.row[m]] if s.row[m] < s.n_j + s.n_c else 0.0  # tangents have none
    return largest(s.change, 0.0, s.n_held) > 0.0


def take_rows(s: Rows, t: float, q: Doubles, v: Doubles) -> bool:
    """Rows, rates and factors of the rows held at this state; False where these have become dependent."""
    return (s.known or factor_mass(s.model, s.inside(t), q, v, s.M)) and renew_held(s, t, q, v)
