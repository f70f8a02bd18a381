"""Runs of one linear degree of freedom above a flat obstacle, whose flights are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events.flight.contact import STRIDE
from lcpstep.events.flight.keep import evaluate
from lcpstep.events.flight.loop import Course
from lcpstep.events.flight.motion import Flight
from lcpstep.events.flight.oscillator import Oscillator, oscillator_of
from lcpstep.events.flight.reach import reach
from lcpstep.events.running import Between, EventRun, without_impulses
from lcpstep.events.scan import scan_interval, seen
from lcpstep.kernels.model import Model
from lcpstep.model import model
from lcpstep.recording import Kept, Recorder, States
from lcpstep.turns import turns

Array = NDArray[np.float64]
KNOWN: WeakKeyDictionary[Scene, tuple[Any, dict[str, float]]] = WeakKeyDictionary()  # what scenes have told


def bounds(scene: Scene, m: Model, o: Any, method: Any) -> dict[str, float]:
    """What a flight is given by name, see `motion.Flight`.

    The scene is looked at once, unless its functions are compiled anew, or are in Python, which may see to changes.
    """
    functions, (of, told) = (m.frame.address, m.motion.address), KNOWN.get(scene, (None, {}))
    if m.kept or functions != of:
        told = bounds_of_motion(scene, m, o)
        KNOWN[scene] = functions, told
    return told | {"rtol": method.rtol, "atol": method.atol}


def bounds_of_motion(scene: Scene, m: Model, o: Any) -> dict[str, float]:
    """The same but for tolerances."""
    rate = max(math.sqrt(abs(o.w2)), abs(o.delta), abs(o.Omega))
    samples = seen(scene, m) if m.frame.given or m.motion.given else None
    given = {"scan": scan_interval(scene, m, rate, samples)}
    if scene.n_c == 0:
        return given | {"clear": math.inf, "bend": 0.0, "size": 0.0, "speed": 0.0}
    far = reach(scene, m, samples)
    G, offset = float(m.arrays["G"][0, 0]), float(m.arrays["offset"][0])
    forced = abs(G) * math.hypot(o.X, o.Y)
    return given | {
        "clear": far.clear, "bend": far.bend,
        "size": far.size + abs(offset) + forced, "speed": far.speed + forced * abs(o.Omega),
    }  # fmt: skip


def flight_of(scene: Scene, m: Model, o: Any, given: dict[str, float], *counted: Any) -> Flight:
    """What the kernels are handed; the state starts as the scene's. counted: record and tally, or nothing."""
    flight = Flight(scene.t_span, turns(scene).stops, scene.period, m, o, given, *counted)
    flight.state[0], flight.state[1] = scene.q0, scene.v0
    return flight


class ClosedForm(EventRun):
    """A run in closed form."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, o: Oscillator) -> None:
        super().__init__(method, scene, kept, Recorder(1, scene.n_c, kept))
        self.model, self.oscillator = m, o
        self.given = bounds(scene, m, o, method)
        self.flight = flight_of(scene, m, o, self.given, self.recorder.record, self.tally)
        self.course = Course(self.flight)

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return self.flight.now

    @property
    def horizon(self) -> float:
        """End of the interval at hand [s]."""
        f = self.flight
        return min(f.t_end, f.high, f.now + STRIDE * f.scan)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.flight.state[0], self.flight.state[1]

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the flights that start there."""
        complete = self.kept.all or self.kept.on_events
        return Flights(without_impulses(s), complete, self.scene, self.model, self.given)


@dataclass(eq=False)
class Flights(Between):
    """States between kept ones, in closed form."""

    scene: Scene
    model: Model | None  # of the scene, good in this process only
    given: dict[str, float]  # see `bounds`

    def __getstate__(self) -> dict[str, Any]:
        """What is good in any process."""
        return vars(self) | {"model": None}

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        m = self.model = self.model or model(self.scene)
        q, v = np.zeros((2, len(times), 1))
        evaluate(flight_of(self.scene, m, oscillator_of(m), self.given), self.s, times, row, q, v)
        return q, v
