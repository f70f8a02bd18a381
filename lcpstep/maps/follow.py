"""Many event-driven runs over many periods of the forcing, in one call of a kernel.

For systems whose smooth motion is known in closed form a period takes microseconds, and all that Python does per
run would cost more than the run. See `flights` for the kernel.
"""

from __future__ import annotations

from copy import copy
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.callbacks.faults import cause
from lcpstep.events import EventDriven
from lcpstep.events.flight.oscillator import oscillator_of
from lcpstep.events.flight.run import bounds, flight_of
from lcpstep.kernels.tally import Tally
from lcpstep.maps.flights import Runs, follow
from lcpstep.maps.tangent import along_logs
from lcpstep.maps.task import INSIDE as INSIDE
from lcpstep.maps.task import UNREACHED as UNREACHED
from lcpstep.maps.task import Task
from lcpstep.model import model
from lcpstep.pace import Pace
from lcpstep.recording import Kept, Recorder

PERIODS_OF_SPAN = 4  # of the span that the scan for events is made for
PORTION = 65536  # periods between two looks at the outside world, at most


class Follower:
    """A scene made ready for `follow`: its model, and work space. One thread at a time may use it."""

    def __init__(self, scene: Scene, method: EventDriven) -> None:
        self.scene, self.method = scene, method
        self.model = model(scene)
        self.oscillator = oscillator_of(self.model)

    @property
    def usable(self) -> bool:
        """Whether the motion is known in closed form; other systems take the general way."""
        return self.oscillator is not None

    def run(self, task: Task, strict: bool) -> None:
        """Fill in the answers of the task; unless strict, a start inside of the obstacle is taken as one on it."""
        record = Recorder(1, self.scene.n_c, Kept(0, False, np.zeros(0))).record
        given = self.given()
        runs = Runs(
            self.flight(given, record, Tally(self.method.max_events)),
            self.flight(given),
            task._replace(strict=strict),
        )
        pace, over = Pace(PORTION, total=task.periods * len(task.starts)), False
        while not over:
            over = follow(runs, pace.goal(runs.taken))
            cause()  # an interrupt of the keyboard, while a function of the user's was at work

    def given(self) -> dict[str, float]:
        """What a flight is given by name; the scan for events is made for some periods, whatever the span."""
        scene = self.scene
        spanned = copy(scene)  # a checked scene needs no further check
        object.__setattr__(
            spanned, "t_span", (scene.t_span[0], scene.t_span[0] + PERIODS_OF_SPAN * scene.period)
        )
        return bounds(spanned, self.model, self.oscillator, self.method)

    def flight(self, given: dict[str, float], *counted: Any) -> Any:
        """A flight of the scene."""
        return flight_of(self.scene, self.model, self.oscillator, given, *counted)

    def tangents_of(self, log: Any, counts: Any, t_start: float) -> Any:
        """Derivatives of periods from their impacts, as recorded by any method; see `tangent.along_logs`."""
        out = np.zeros((*counts.shape[:2], 2, 2))
        log, counts = np.ascontiguousarray(log), np.ascontiguousarray(counts, dtype=np.intp)
        along_logs(self.flight(self.given()), log, counts, t_start, t_start + self.scene.period, out)
        return out
