"""A run of `Located` of a scene with friction or joints."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, LinearJoints, Scene
from lcpstep.events.contacts.run import ContactRun, start
from lcpstep.recording import States
from lcpstep.stepping.again import Again
from lcpstep.stepping.by_tolerance.sizes import FIRST
from lcpstep.stepping.extent import sizes
from lcpstep.stepping.rubbing.steps import RubbingSteps
from lcpstep.stepping.steps import divided
from lcpstep.trajectory import Status

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

Array = NDArray[np.float64]
# Of the state at hand, and of the whole motion, or in metres and m/s where that is less: hops that rise no higher,
# and sliding velocities of this size, are over
ROUNDING = 1e-12
SOON = 5.0  # intervals between looks: how far ahead forces count for the size of the motion


class RubbingRun(ContactRun):
    """A run by steps of one size, the last one shortened where they do not divide the span, or by a tolerance."""

    method: Located

    def start(self, scene: Scene, method: Located) -> RubbingSteps:
        """The motion at the start of the span."""
        parts = list(divided(scene.t_span, method.h))
        h, n = parts[0][0], parts[-1][3]
        system: RubbingSteps = start(
            scene, RubbingSteps, ROUNDING, ROUNDING, order=int(method.order), h=h,
            t_start=float(scene.t_span[0]), n_steps=n, tolerance=method.tolerance or 0.0,
        )  # fmt: skip
        at = float(scene.t_span[0]), np.array(scene.q0), np.array(scene.v0)
        rows = system.rows
        rows.far, rows.fast, rows.longest = sizes(rows.model, *at, SOON * system.scan_length)
        span = scene.t_span[1] - scene.t_span[0]
        system.next_step = FIRST * span if method.tolerance else h
        return system

    def is_dense(self, method: Located, scene: Scene) -> bool:
        """Whether cubics between kept states are as good as the steps.

        Short ones of order two, and all where cubics stay on the rows held: on straight ones, at rest.
        """
        short = method.order == 2 and method.tolerance is None
        return short or (is_straight(scene.contacts) and is_straight(scene.joints))

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time: by the cubics, or by another run."""
        if self.is_dense(self.method, self.scene):
            return super().dense(s)
        return Again(self.method, self.scene, *self.state)

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


def is_straight(rows: Any) -> bool:
    """Whether contacts or joints have constant Jacobians and do not move by themselves."""
    return rows is None or (isinstance(rows, (LinearContacts, LinearJoints)) and rows.motion is None)
