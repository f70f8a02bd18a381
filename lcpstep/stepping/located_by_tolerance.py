"""Steps of `Located` chosen by a tolerance: what one step and its two halves do.

A step stops at its first event, and at a corner; what comes after is compared anew. So both runs are smooth: the
one is a single piece without a look at contacts, up to the time at which the halves have met an event, and
positions and velocities are compared just before it. What the forces of closed contacts hide from that, see
`hidden_forces`. The loop of the fixed steps takes each part.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import cython
import numpy as np

from lcpstep.kernels.record import Record
from lcpstep.stepping.adaptive import LEVELS, PAUSED, REACHED, WANTED
from lcpstep.stepping.pieces.state import Plan, Polynomial, Work
from lcpstep.stepping.step_control import Control

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.kernels.linear import factorise, solve
    from lcpstep.kernels.model import Model
    from lcpstep.kernels.record import COLUMNS, LEAD, Record
    from lcpstep.kernels.vectors import copy, largest, product
    from lcpstep.pointers import Doubles, abs, after, inf, indices_after, max, min, nan
    from lcpstep.stepping.hidden_forces import hidden, late
    from lcpstep.stepping.pieces.codes import BUFFER_FULL, CLOSED, FINISHED, RELEASE, STOPPED, WHOLE

EARLY = 1 / 32  # of a step: an event before it leaves nothing to compare
NEAR = 3.0  # errors of a gap: from where on it may have closed
TRIALS = 4  # of a step whose event comes at another time


class Led:
    """Where a run led.

    code, time      why it ended, and when, since the start of the step
    q, v            before an event there
    gap, half       gaps, and halves of their accelerations over the piece
    status          OPEN or CLOSED
    force, impulse  over the piece, and since the start of the step, of contacts where some were closed
    """

    def __init__(self, n_q: int, n_c: int) -> None:
        self.kept = np.zeros(2 * n_q + 4 * n_c), np.zeros(n_c, dtype=np.intp)
        self.q, self.status = doubles(self.kept[0]), indices(self.kept[1])
        self.v, self.gap = after(self.q, n_q), after(self.q, 2 * n_q)
        self.half, self.force = after(self.gap, n_c), after(self.gap, 2 * n_c)
        self.impulse = after(self.gap, 3 * n_c)
        self.code, self.time = FINISHED, 0.0

    def good(self) -> bool:
        """Whether it could be taken."""
        return self.code in (FINISHED, STOPPED)


class Start:
    """The state at the start of a step, and the last row, which an event at its time changes."""

    def __init__(self, w: Work, row_size: int) -> None:
        self.kept = tuple(np.zeros_like(x) for x in (w.numbers, w.marks, w.matrices)) + (np.zeros(row_size),)
        self.other = Work(w.n_q, w.n_c, w.joints)

