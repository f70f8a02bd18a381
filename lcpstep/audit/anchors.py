"""How far runs by a tolerance may be off beside their own events, and where forces along them say how far.

A run that restarts at an event of a contact goes on from a gap of zero: a time d after it, or before the next one,
the gap is off by no more than d times what the gap velocity is off by. That holds while no impact of another contact
lies in between, whose own time may be off.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lcpstep.audit.windows import Windows

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


class Anchors:
    """Events from which a motion goes on.

    estimated   (m, n_q)   how far forces along the motion let it be off, or None: not asked for

    Parameters
    ----------
    t : (m + 1,);  touched : (m + 1, n_c)   events of the contacts
    jumps : () -> (m + 1,)   where velocities jump, which is asked for where it matters
    error : (absolute, relative)   of positions, and of velocities;  motion : Polynomials
    """

    def __init__(
        self, t: Array, touched: Mask, jumps: Callable[[], Mask], error: tuple[Any, float], motion: Any
    ) -> None:
        self.t, self.touched, self.jumps, self.error, self.motion = t, touched, jumps, error, motion
        self.estimated: Array | None = None

    @functools.cached_property
    def around(self) -> tuple[Array, Array]:
        """How long ago every contact had an event, and how long it is to the next one, (m + 1, n_c) each."""
        jumps = self.jumps()
        return (
            apart(self.t, self.touched, jumps),
            apart(-self.t[::-1], self.touched[::-1], jumps[::-1])[::-1],
        )

    def errors(self, w: Windows, size: Array) -> Array:
        """How far the coordinates may be off in windows, (n, n_q); size (n,): of the positions."""
        absolute, relative = self.error
        n = self.motion.B.shape[2]
        off = np.repeat((absolute + relative * size)[:, None], n, axis=1)
        if self.estimated is not None:
            off = np.minimum(off, self.estimated[w.k])
        since, until = self.around
        after = since[w.k, w.c] + (w.b - self.t[w.k])
        before = until[w.k + 1, w.c] + (self.t[w.k + 1] - w.a)
        rate = absolute + relative * self.motion.fastest(w.k)
        return np.asarray(np.minimum(off, np.minimum(after, before)[:, None] * rate))


def apart(t: Array, touched: Mask, jumps: Mask) -> Array:
    """How long ago every contact had an event, (m + 1, n_c); infinite where another one's jump lies between."""
    number = np.arange(len(t))
    own = np.maximum.accumulate(np.where(touched, number[:, None], -1), axis=0)
    jump = np.maximum.accumulate(np.where(jumps, number, -1))
    return np.where((own >= 0) & (own >= jump[:, None]), t[:, None] - t[own], np.inf)
