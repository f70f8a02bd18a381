"""A run of `Located`: what its loop works in, and why it ended early, in words."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.doubts.jolts import jolts_of
from lcpstep.errors import SimulationError
from lcpstep.gaps import no_way_out
from lcpstep.kernels.looks import all_finite
from lcpstep.model import model
from lcpstep.recording import SPARE, Kept, Recorder, States
from lcpstep.stepping.again import Again
from lcpstep.stepping.by_tolerance import sizes
from lcpstep.stepping.by_tolerance.located import Attempts
from lcpstep.stepping.interpolation import Bent
from lcpstep.stepping.pieces.carried import displaced
from lcpstep.stepping.pieces.polynomial_steps import PolynomialSteps
from lcpstep.stepping.pieces.prepare import MANY_EXACTLY, carried_where_possible, matrices, plan, start
from lcpstep.stepping.pieces.quadratic_steps import QuadraticSteps
from lcpstep.stepping.pieces.state import Plan
from lcpstep.stepping.step_run import StepRun
from lcpstep.stepping.steps import number
from lcpstep.trajectory import Counts, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.located import Located

Array = NDArray[np.float64]
PORTION = 16384  # steps between two looks at the outside world, at most
TRIALS = 17  # of the callbacks within a step that failed


class LocatedRun(StepRun):
    """One run: the loop with its state."""

    def __init__(self, method: Located, scene: Scene, kept: Kept) -> None:
        self.model = carried_where_possible(model(scene), method.order)
        p = plan(scene, self.model, method, method.h)
        self.work = start(scene, self.model, p)
        steps = kept.of_steps(number(scene.t_span, method.h)) if method.tolerance is None else None
        expected = None if steps is None else steps + steps // 16 + SPARE  # and events
        recorder = Recorder(scene.n_q, scene.n_c, kept, expected=expected)
        super().__init__(method, scene, kept, recorder, PORTION)
        self.impulse = self.work.seen["impulse"]
        kind = QuadraticSteps if method.order == 2 else PolynomialSteps
        self.work.record = recorder.record
        self.loop = kind(self.model, p, self.work)

    def begin(self) -> int:
        """The initial state; a code."""
        code = int(self.loop.begin(self.scene.t_span[0]))
        p, tolerance = self.plan, self.method.tolerance
        # Steps that make no error are of one size
        if tolerance is not None and not (p.plain and p.steady and tolerance >= sizes.ROUNDED):
            p.many, order = MANY_EXACTLY, int(self.method.order)
            span, h = self.scene.t_span, self.method.h
            self.controlled_by(
                Attempts(self.loop, lambda h: matrices(self.model, self.method, h), span, h, tolerance, order)
            )
        return code

    def plan_for(self, h: float) -> Plan:
        """Constants of steps of size h."""
        return plan(self.scene, self.model, self.method, h)

    def advance(self, goal: int) -> int:
        """Call the kernel, for `done` to become `goal` at most; why it returned."""
        self.work.events_left = self.method.max_events - self.recorder.taken
        return super().advance(goal)

    def take(self, last: int) -> int:
        """Steps up to the one before `last`; why the kernel returned."""
        return int(self.loop.run(self.t0, self.first, last))

    @property
    def steps(self) -> int:
        """Steps taken."""
        return int(self.work.steps)

    @property
    def now(self) -> float:
        """Time of the current state, after a step that failed of the last finite one [s]."""
        if self.finite is not None:
            return self.finite[0]
        return self.reached

    @property
    def reached(self) -> float:
        """Time that the kernel has reached, within the step at hand too [s]."""
        t = self.t0 + self.plan.h * (self.work.steps - self.first)
        return float(t + self.work.sigma * self.work.under_way)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        if self.finite is not None:
            return self.finite[1:]
        q, v = self.work.seen["q"], self.work.seen["v"]
        if not self.model.carried:
            return q.copy(), v.copy()
        c, c_t = displaced(self.model, self.reached)
        return q - c, v - c_t

    @property
    def ahead(self) -> Array:
        """Times at which a callback may be what has failed [s]."""
        return np.linspace(self.now, self.reached + self.plan.h, TRIALS)

    @property
    def counts(self) -> Counts:
        """Work done."""
        w = self.work
        return Counts(w.steps, w.lcp_calls, w.force_evaluations, self.recorder.taken)

    def empty(self) -> None:
        """Take over what the kernel has written; an event may still change the last state."""
        self.put_back(self.recorder.record.row - 1)
        super().empty()

    def put_back(self, end: int) -> None:
        """Kept states up to before the end in the coordinates of the scene."""
        if self.model.carried:
            self.loop.put_back(end)

    def states(self) -> States:
        """All states kept; a step that failed may have left its numbers behind."""
        self.put_back(self.recorder.record.row)
        s = super().states()
        if self.finite is None and (s.t.size > 0 or all(map(all_finite, self.state))):
            return s
        m = self.before_failing()
        if m is not None and (self.finite is None or m.t[-1] > self.finite[0]):
            self.finite = float(m.t[-1]), m.q[-1], m.v[-1]
            if not self.kept.given:
                since = np.maximum(np.sum(m.impulse, axis=0) - np.sum(s.impulse, axis=0), 0.0)
                return s.and_then(*self.finite, since, 1.0)
        return s

    def before_failing(self) -> Trajectory | None:
        """Another run up to the step that failed; None where its beginning is kept."""
        begin, t = self.scene.t_span[0], self.t0 + self.plan.h * (self.work.steps - 1 - self.first)
        if self.control is not None or self.kept.all or not t > begin:
            return None
        scene = replace(self.scene, t_span=(begin, t))
        try:
            return type(self)(self.method, scene, Kept.parse("impacts", scene.t_span)).finish(
                lambda now: None
            )
        except SimulationError:  # which hangs on how numbers near their end are rounded
            return None

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time: from the kept ones where these tell, by another run where they do not.

        Steps by a tolerance are as long as what moves allows at their ends: in between an obstacle goes its own way.
        Where the velocity of a frame jumps in a step, what the frame carries has a kink there.
        """
        told = self.method.order == 2 and (self.method.tolerance is None or self.plan.plain)
        if told and not (self.model.carried and len(jolts_of(self.scene))):
            return Bent(s.t, s.q, s.v, self.kept.all, s.mode)
        return Again(self.method, self.scene, *self.state)

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        text, cut = super().message(code), self.work.cut
        if code != Status.DONE or cut == 0:
            return text
        events = f"events without end, or more than max_per_step = {self.method.max_per_step} in a step"
        return f"{text}; {cut} times one plastic impact stood for {events}"

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.LCP_FAILED:
            n = self.work.members
            contacts = sorted(self.work.seen["chosen"][:n].tolist())
            words = f"no impulses or forces satisfy contact{'s' * (n > 1)} {contacts} together"
            return f"{no_way_out(self.scene, self.now, self.state[0], contacts) or words} {self.where}"
        return super().why(code)
