"""Runs of one linear degree of freedom above a flat obstacle, whose flights are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.events import flight, single
from lcpstep.events.oscillator import Oscillator, oscillator
from lcpstep.events.reach import reach
from lcpstep.events.run import Run, between, scan_interval
from lcpstep.model import ABSENT, Model
from lcpstep.recording import Kept, States

Array = NDArray[np.float64]


def oscillator_of(scene: Scene, m: Model) -> Oscillator | None:
    """The scene's motion between events in closed form; None where it has none."""
    if not (m.linear and scene.n_q == 1 and scene.n_c <= 1 and m.flat and m.force == ABSENT):
        return None
    mass, damping, stiffness = (float(x[0, 0]) for x in (m.M, m.C, m.K))
    constant, cosine, sine = (float(x[0]) for x in (m.constant, m.cosine, m.sine))
    result: Oscillator | None = oscillator(mass, damping, stiffness, constant, cosine, sine, m.omega)
    return result


def numbers(scene: Scene, m: Model, o: Oscillator, method: Any) -> Array:
    """Constants and initial state of a flight, the array x of `flight`."""
    x = np.zeros(flight.N_NUMBERS)
    mass, t0 = float(m.M[0, 0]), scene.t_span[0]
    for place, value in {
        flight.DELTA: o.delta, flight.W2: o.w2, flight.F0: o.f0, flight.X: o.X, flight.Y: o.Y,
        flight.OMEGA: o.Omega, flight.FC: m.cosine[0] / mass, flight.FS: m.sine[0] / mass,
        flight.RTOL: method.rtol, flight.ATOL: method.atol, flight.PERIOD: scene.period,
        flight.SCALE: scene.period if math.isfinite(scene.period) else scene.t_span[1] - t0,
        flight.SCAN: scan_interval(scene, m, max(math.sqrt(abs(o.w2)), abs(o.delta), abs(o.Omega))),
        flight.T_END: scene.t_span[1], flight.NOW: t0, flight.LOW: math.inf, flight.HIGH: -math.inf,
        flight.HOLD: -math.inf, flight.LAST_EVENT: -math.inf, flight.CLEAR: math.inf,
    }.items():  # fmt: skip
        x[place] = value
    if scene.n_c == 1:
        G = float(m.G[0, 0])
        x[flight.CONTACT], x[flight.G], x[flight.OFFSET] = 1.0, G, m.offset[0]
        x[flight.CLEAR], x[flight.BEND] = reach(scene, m)
        x[flight.R], x[flight.RESPONSE] = m.restitution[0], G * G / mass
    return x


def flight_of(scene: Scene, m: Model, x: Array) -> flight.Flight:
    """What the kernels are handed; the state starts as the scene's."""
    return flight.Flight(
        x=x, frame=m.frame, motion=m.motion, p=m.p, corners=np.array(scene.corners), now=np.zeros((1, 3)),
        q=np.array(scene.q0), v=np.array(scene.v0),
    )  # fmt: skip


class ClosedForm(Run):
    """A run in closed form."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, fast: bool, o: Oscillator) -> None:
        super().__init__(method, scene, kept, dense=False)
        self.model = m
        self.start = numbers(scene, m, o, method)
        self.flight = flight_of(scene, m, self.start.copy())
        self.fast = fast
        self.run = compiled(single.run) if fast else single.run

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.flight.x[flight.NOW])

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        x = self.flight.x
        return float(min(x[flight.T_END], x[flight.HIGH], x[flight.NOW] + single.STRIDE * x[flight.SCAN]))

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.flight.q, self.flight.v

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        return int(self.run(self.flight, self.recorder.buffers, self.count, goal))

    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""
        single.keep(self.flight, self.recorder.buffers, self.count, self.now)

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the flights that start there."""

        def evaluate(times: Array, row: Any) -> tuple[Array, Array]:
            kernel = compiled(single.evaluate) if self.fast else single.evaluate
            out = single.Wanted(times, row, np.zeros((len(times), 1)), np.zeros((len(times), 1)))
            kernel(flight_of(self.scene, self.model, self.start.copy()), s, out)
            return out.q, out.v

        result: Callable[[Array], tuple[Array, Array]] = between(
            self.kept.all or self.kept.on_events, s, evaluate
        )
        return result
