"""A run of `Located` of a scene with friction or joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lagrangian import Scene
from lcpstep.events.contacts.run import ContactRun, start
from lcpstep.stepping.adaptive import FIRST
from lcpstep.stepping.rubbing.steps import RubbingSteps
from lcpstep.stepping.steps import divided
from lcpstep.trajectory import Status

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

# Absolute and relative: hops that rise no higher, and sliding velocities of this size, are over
ROUNDING = 1e-12


class RubbingRun(ContactRun):
    """A run by steps of one size, the last one shortened where they do not divide the span, or by a tolerance."""

    method: Located

    def start(self, scene: Scene, method: Located) -> RubbingSteps:
        """The motion at the start of the span."""
        parts = list(divided(scene.t_span, method.h))
        h, n = parts[0][0], parts[-1][3]
        steps = int(method.order), h, float(scene.t_span[0]), n, method.tolerance or 0.0
        system: RubbingSteps = start(scene, RubbingSteps, ROUNDING, ROUNDING, *steps)
        span = scene.t_span[1] - scene.t_span[0]
        system.next_step = FIRST * span if method.tolerance else h
        return system

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.PROJECTION_FAILED:
            i, n_j = self.system.astray, self.scene.n_j
            what = f"joint {i}" if i < n_j else f"contact {(i - n_j) % self.scene.n_c}, which is closed,"
            others = " and the others" if n_j + len(self.closed_ones) > 1 else ""
            return f"no position near satisfies {what}{others} {self.where}; try a smaller h"
        return super().why(code)

    @property
    def horizon(self) -> float:
        """How far ahead the run looks [s]."""
        return min(self.now + self.method.h, self.scene.t_span[1])
