"""Many time-stepping runs in lockstep: time in the outer loop, the runs in the inner one; `lanes` is the kernel."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.callbacks.faults import cause
from lcpstep.maps.answers import Answers
from lcpstep.maps.lanes import Lanes, advance, note_touching
from lcpstep.maps.task import INSIDE, Task
from lcpstep.model import models
from lcpstep.pace import Pace
from lcpstep.stepping.moreau import Moreau
from lcpstep.stepping.moreau_run import plan, rows
from lcpstep.stepping.steps import RESTING, divided, start_side
from lcpstep.stepping.theta_method.moving import Plan
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
PORTION = 65536  # steps between two looks at the outside world, at most
ROUNDING = 64 * np.finfo(float).eps


class Lockstep:
    """A scene made ready for `advance`."""

    def __init__(self, scene: Scene, method: Moreau) -> None:
        self.scene, self.method = scene, method
        self.model, joints, tangents = models(scene)
        self.rows = rows(scene, joints, tangents, projected=False, external=False)

    @property
    def usable(self) -> bool:
        """Whether all runs share forcing and obstacle: one linear degree of freedom, one flat contact."""
        m = self.model
        return bool(
            m.linear
            and m.flat
            and self.scene.n_q == 1
            and self.scene.n_c == 1
            and self.method.lcp == "lemke"
            and self.method.tolerance is None
        )

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task."""
        x = task.starts
        own = {name: np.zeros(len(x)) for name in ("g", "u", "p", "before", "slack")}
        own |= {"q": x[:, 0].copy(), "v": x[:, 1].copy()}
        lanes, answers = Lanes(own), Answers(task)
        self.measure(own, task.t_start)
        size = np.maximum(1.0, np.abs(own["q"]))
        if strict:
            task.codes[own["g"] < -ROUNDING * size] = INSIDE
        stretches = list(self.stretches(task.t_start, task.t_end))
        steps = sum(last - first for _, _, first, last in stretches)
        pace, done = Pace(PORTION, len(x), task.periods * steps), 0
        for period in range(task.periods):
            k = period - task.drop
            self.measure(own, task.t_start)
            lanes.take(stretches[0][0])
            note_touching(self.model, lanes, start_side(self.scene, task.t_start))
            for p, t0, first, last in stretches:
                begin, side = first, start_side(self.scene, t0)
                lanes.take(p)
                while begin < last:
                    until = min(last, begin + pace.goal(done) - done)
                    advance(self.model, lanes, answers, t0, side, first, begin, until, k)
                    cause()  # an interrupt of the keyboard, while a function of the user's was at work
                    done += until - begin
                    begin, side = until, t0 + p.h * (until - first)
            if k >= 0:
                task.states[:, k, 0], task.states[:, k, 1] = own["q"], own["v"]
        task.final[:, 0], task.final[:, 1] = own["q"], own["v"]
        task.taken[:] = task.periods
        lost = ~np.all(np.isfinite(task.final), axis=1) & (task.codes == Status.DONE)
        task.codes[lost] = Status.NOT_FINITE
        task.taken[task.codes == INSIDE] = 0

    def measure(self, own: dict[str, Array], t: float) -> None:
        """Gaps, gap velocities and what counts as closed, at the start of a period."""
        nobody, s = np.zeros(1), np.zeros((1, 3))
        if self.scene.contacts.motion is not None:  # type: ignore[union-attr]
            side = start_side(self.scene, t)
            self.scene.contacts.motion(side, nobody, nobody, np.array(self.scene.p), s)  # type: ignore[union-attr]
        G, offset = self.model.arrays["G"][0, 0], self.model.arrays["offset"][0]
        own["g"][:] = offset - s[0, 0] + G * own["q"]
        own["u"][:] = G * own["v"] - s[0, 1]
        size = np.maximum(np.maximum(np.abs(own["q"]), abs(offset)), np.abs(self.method.h * own["v"]))
        own["slack"][:] = RESTING * np.where(size == 0.0, 1.0, size)

    def stretches(self, t_start: float, t_end: float) -> Iterator[tuple[Plan, float, int, int]]:
        """The steps of a span, as `Moreau` takes them: whole ones, and a shorter last one where they do not fit."""
        for h, t0, first, last in divided((t_start, t_end), self.method.h):
            yield plan(self.model, self.rows, h, self.method.theta, 0.0, constant=True), t0, first, last
