"""Steps of one size of a system with friction or joints, as the loop over events takes them."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.events.contacts.loose import straying
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.pointers import after
    from lcpstep.stepping.rubbing.found import know_biases, read_guards
    from lcpstep.stepping.rubbing.stride import stride
    from lcpstep.stepping.rubbing.strides import Strides


class RubbingSteps(Strides):
    """The motion of `Strides`, which goes on by a step, or up to the first event within it."""

    def proceed(self, record: Record, tally: Tally) -> int:
        """Go on up to the first event, no further than the end of the step at hand; a status."""
        return stride(self, record, tally)

    def straying_at(self, place: float, h: float, level: float) -> int:
        """The first contact that has a row leave its rest at that fraction of the step, which is made up to there."""
        t = self.clock.t0 + place * h
        if not (self.step(self.clock.t0, place * h) and read_guards(self, t, self.y_new)):
            return -1
        know_biases(self, t, self.y_new)
        return straying(self, after(self.arrival, self.n_q), level)
