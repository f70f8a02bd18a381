"""Runs of one contact that stays closed and rubs along a line, whose arcs are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events.arcs.line import Line, line_of
from lcpstep.events.arcs.loop import Course, evaluate
from lcpstep.events.arcs.motion import Arc, state_at
from lcpstep.events.running import Between, EventRun, without_impulses
from lcpstep.events.scan import PER_PERIOD
from lcpstep.recording import Kept, Recorder, States

Array = NDArray[np.float64]


def longest_step(scene: Scene, line: Line) -> float:
    """Time between states that are kept by steps: a part of the fastest oscillation, or of the span [s]."""
    o = line.oscillator
    rate = max(math.sqrt(o.w2), abs(o.Omega), abs(line.slip[3]))
    span = scene.t_span[1] - scene.t_span[0]
    return min(span, 2.0 * math.pi / rate if rate > 0.0 else math.inf) / PER_PERIOD


class ArcRun(EventRun):
    """A run in closed form."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, line: Line) -> None:
        super().__init__(method, scene, kept, Recorder(2, 2, kept))
        stride = longest_step(scene, line) if kept.every > 0 else math.inf
        record = self.recorder.record
        self.arc = Arc(line, scene.t_span, stride, method.rtol, method.atol, record, self.tally)
        self.course = Course(self.arc)

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.arc.now)

    @property
    def horizon(self) -> float:
        """End of the interval at hand [s]."""
        return float(self.arc.t_end)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        state_at(self.arc, self.arc.now - self.arc.t0)
        return self.arc.state[0], self.arc.state[1]

    def begin(self) -> int:
        """The contact sticks or slides from the start; a code."""
        return self.advance(0)

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the arcs that start there."""
        return Arcs(without_impulses(s), self.kept.all or self.kept.on_events, self.scene)


@dataclass(eq=False)
class Arcs(Between):
    """States between kept ones, in closed form."""

    scene: Scene

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        line: Any = line_of(self.scene)
        contacts: Any = self.scene.contacts
        arc = Arc(line, self.scene.t_span, math.inf, 0.0, 0.0)
        tangent = np.asarray(contacts.friction.tangent)[0]
        q, v = np.zeros((2, len(times), 2))
        evaluate(arc, self.s, np.stack([self.s.q @ tangent, self.s.v @ tangent], axis=1), times, row, q, v)
        return q, v
