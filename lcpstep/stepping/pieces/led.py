"""Where the runs that steps by a tolerance compare have led, and the state that they start from."""

from __future__ import annotations

import cython
import numpy as np

if not cython.compiled:
    from lcpstep.arrays import doubles, indices
    from lcpstep.kernels.vectors import copy, copy_indices
    from lcpstep.pointers import after
    from lcpstep.stepping.pieces.codes import FINISHED, STOPPED
    from lcpstep.stepping.pieces.state import Work


class Led:
    """Where a run led.

    code, time      why it ended, and when, since the start of the step
    q, v            before an event there;  off   how far it was put there from where its piece had led
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
        self.code, self.time, self.off = FINISHED, 0.0, 0.0

    def good(self) -> bool:
        """Whether it could be taken."""
        return self.code in (FINISHED, STOPPED)


def copy_state(to: Work, w: Work, n_numbers: int, n_marks: int, n_matrices: int) -> None:
    """All of a motion's state: so many numbers, marks, and numbers of matrices that change."""
    copy(to.q, w.q, n_numbers)
    copy_indices(to.status, w.status, n_marks)
    copy(to.G, w.G, n_matrices)
    to.sigma, to.end, to.low, to.high = w.sigma, w.end, w.low, w.high
    to.stalled, to.settled, to.ahead, to.blind, to.goal = w.stalled, w.settled, w.ahead, w.blind, w.goal
    to.under_way, to.unchanged, to.touching, to.pausing = w.under_way, w.unchanged, w.touching, w.pausing
    to.fresh = w.fresh
    to.events, to.closed_now, to.made_with = w.events, w.closed_now, w.made_with
    to.steps, to.lcp_calls, to.force_evaluations = w.steps, w.lcp_calls, w.force_evaluations
    to.events_left, to.cut, to.members, to.idle = w.events_left, w.cut, w.members, w.idle
