"""Steps of a system with friction or joints, of one size or by a tolerance, as the loop over events takes them."""

from __future__ import annotations

import cython

from lcpstep.events.contacts.loose import straying_seen
from lcpstep.kernels.vectors import copy
from lcpstep.pointers import after
from lcpstep.stepping.rubbing.stride import stride
from lcpstep.stepping.rubbing.strides import Strides, push_end_back


class RubbingSteps(Strides):
    """The motion of `Strides`, which goes on by a step, or up to the first event within it."""

    def proceed(self) -> int:
        """Go on up to the first event, no further than the end of the step at hand; a status."""
        return stride(self)

    def straying_at(self, place: float, h: float, level: float) -> int:
        """The first contact that has a row leave its rest at that fraction of the step, which is made up to there.

        Accelerations are those of the velocity on the rows held: beside it rows that depend on these seem to leave.
        """
        t = self.rows.t0 + place * h
        if not self.step(self.rows.t0, place * h):
            return -1
        copy(self.seen, self.y_new, self.n)
        push_end_back(self, after(self.seen, self.n_q))
        return straying_seen(self, t, level)
