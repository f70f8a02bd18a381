"""Steps of one size of a system with friction or joints, as the loop over events takes them."""

from __future__ import annotations

import cython

if not cython.compiled:
    from lcpstep.kernels.record import Record
    from lcpstep.kernels.tally import Tally
    from lcpstep.stepping.rubbing.stride import stride
    from lcpstep.stepping.rubbing.strides import Strides


class RubbingSteps(Strides):
    """The motion of `Strides`, which goes on by a step, or up to the first event within it."""

    def proceed(self, record: Record, tally: Tally) -> int:
        """Go on up to the first event, no further than the end of the step at hand; a status."""
        return stride(self, record, tally)
