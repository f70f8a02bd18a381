"""What runs by steps share: steps of one size, and a last one where that does not divide the span; or steps that a
control chooses by a tolerance (`by_tolerance`).
"""

from __future__ import annotations

from abc import abstractmethod
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.callbacks.faults import cause
from lcpstep.kernels.status import DONE
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder, States
from lcpstep.running import Run
from lcpstep.stepping.by_tolerance.sizes import LOOK, WANTED
from lcpstep.stepping.steps import divided, unresolved


class StepRun(Run):
    """One run by steps.

    loop       the kernel that takes the steps, with its plan
    impulse    since the last kept state
    t0, first  time of a step, and its number
    control    a `by_tolerance.control.Control`, of steps by a tolerance
    """

    loop: Any
    impulse: Any
    control: Any = None

    def __init__(self, method: Any, scene: Scene, kept: Kept, recorder: Recorder, most: int) -> None:
        super().__init__(method, scene, kept, recorder, most)
        # Each (h, time at which it begins, number of its first step, of the step that ends it)
        self.stretches, self.stretch = divided(scene.t_span, method.h), 0
        self.t0, self.first, self.arrived = scene.t_span[0], 0, False

    @property
    @abstractmethod
    def steps(self) -> int:
        """Steps taken."""

    @abstractmethod
    def take(self, last: int) -> int:
        """Call the kernel, for steps up to the one before `last`; why it returned."""

    @abstractmethod
    def plan_for(self, h: float) -> Any:
        """What steps of size h multiply with."""

    def controlled_by(self, control: Any) -> None:
        """Go on in steps that this control chooses."""
        self.control, self.pace = control, Pace(LOOK, self.scene.n_q + self.recorder.record.n_c)

    @property
    def done(self) -> int:
        """Steps taken, or attempted."""
        return self.steps if self.control is None else int(self.control.tried)

    @property
    def over(self) -> bool:
        """Whether the end of the span is reached."""
        return self.arrived if self.control is not None else self.steps >= self.stretches[-1][3]

    @property
    def plan(self) -> Any:
        """What steps of size plan.h multiply with."""
        return self.loop.plan

    @plan.setter
    def plan(self, p: Any) -> None:
        self.loop.plan = p

    @property
    def ahead(self) -> Any:
        """Times at which a callback may be what has failed [s]."""
        return self.now, self.now + self.plan.h

    @property
    def horizon(self) -> float:
        """How far ahead the run looks [s]."""
        return min(self.now + self.method.h, self.scene.t_span[1])

    def advance(self, goal: int) -> int:
        """Call the kernel, for `done` to become `goal` at most; why it returned."""
        if self.control is not None:
            return self.attempt(goal)
        if self.steps >= self.stretches[self.stretch][3] and not self.over:
            self.stretch += 1
        h, self.t0, self.first, last = self.stretches[self.stretch]
        if h != self.plan.h:
            self.plan = self.plan_for(h)
        return self.take(min(last, goal))

    def attempt(self, goal: int) -> int:
        """The same of steps that the control chooses."""
        code = WANTED
        while code == WANTED:
            code = int(self.control.advance(goal))
            cause()  # an interrupt goes on its way
            if code == WANTED:
                self.control.prepare()
        self.arrived = code == DONE and self.control.arrived
        return code

    def empty(self) -> None:
        """Move what the kernels have written to the recorder's keeping."""
        if self.control is not None:
            self.t0, self.first, self.plan.h = self.control.time, self.steps, self.control.step
        super().empty()

    def states(self) -> States:
        """All states kept, and the last one where states are kept by steps or events."""
        s, end = super().states(), self.scene.t_span[1]
        if not self.kept.given and len(s.t) == 0:  # an interrupt before the first step
            q, v = np.array(self.scene.q0), np.array(self.scene.v0)
            s = s.and_then(self.scene.t_span[0], q, v, np.zeros(s.impulse.shape[1]))
        if not self.kept.given and self.now > s.t[-1]:
            s = self.known(s.and_then(self.now, *self.state, self.impulse, 1.0))
        if len(s.t) and abs(s.t[-1] - end) <= unresolved(self.scene.t_span, self.method.h):
            s.t[-1] = end
        return s
