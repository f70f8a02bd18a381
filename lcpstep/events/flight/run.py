"""Runs of one linear degree of freedom above a flat obstacle, whose flights are known in closed form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.compiled import compiled
from lcpstep.events.bookkeeping import Wanted
from lcpstep.events.clock import HIGH, clock
from lcpstep.events.contact import HOLD, NOW, keep
from lcpstep.events.flight import loop, motion
from lcpstep.events.flight.keep import evaluate as states_between
from lcpstep.events.flight.oscillator import Oscillator, oscillator
from lcpstep.events.flight.reach import reach
from lcpstep.events.run import BetweenByModel, Run, one_contact_recorder, scan_interval, without_impulses
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
    """Constants and initial state of a flight, the array x of `motion`."""
    x = clock(scene, motion.N_NUMBERS)
    mass = float(m.M[0, 0])
    for place, value in {
        motion.DELTA: o.delta, motion.W2: o.w2, motion.F0: o.f0, motion.X: o.X, motion.Y: o.Y,
        motion.OMEGA: o.Omega, motion.FC: m.cosine[0] / mass, motion.FS: m.sine[0] / mass,
        motion.RTOL: method.rtol, motion.ATOL: method.atol,
        motion.SCAN: scan_interval(scene, m, max(math.sqrt(abs(o.w2)), abs(o.delta), abs(o.Omega))),
        motion.T_END: scene.t_span[1], NOW: scene.t_span[0], HOLD: -math.inf, motion.CLEAR: math.inf,
    }.items():  # fmt: skip
        x[place] = value
    if scene.n_c == 1:
        G = float(m.G[0, 0])
        x[motion.CONTACT], x[motion.G], x[motion.OFFSET] = 1.0, G, m.offset[0]
        seen = reach(scene, m)
        x[motion.CLEAR], x[motion.BEND] = seen.clear, seen.bend
        forced = abs(G) * math.hypot(o.X, o.Y)
        x[motion.SIZE] = seen.size + abs(m.offset[0]) + forced
        x[motion.RATE] = seen.speed + forced * abs(o.Omega)
        x[motion.R], x[motion.RESPONSE] = m.restitution[0], G * G / mass
    return x


def flight_of(scene: Scene, m: Model, x: Array) -> motion.Flight:
    """What the kernels are handed; the state starts as the scene's."""
    return motion.Flight(
        x=x, frame=m.frame, motion=m.motion, p=m.p, corners=np.array(scene.corners), now=np.zeros((1, 3)),
        q=np.array(scene.q0), v=np.array(scene.v0),
    )  # fmt: skip


class ClosedForm(Run):
    """A run in closed form."""

    def __init__(self, method: Any, scene: Scene, kept: Kept, m: Model, fast: bool, o: Oscillator) -> None:
        super().__init__(method, scene, kept, one_contact_recorder(scene, kept, dense=False))
        self.model = m
        self.start = numbers(scene, m, o, method)
        self.flight = flight_of(scene, m, self.start.copy())
        self.fast = fast
        self.run = compiled(loop.run) if fast else loop.run

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.flight.x[NOW])

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        x = self.flight.x
        return float(min(x[motion.T_END], x[HIGH], x[NOW] + loop.STRIDE * x[motion.SCAN]))

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.flight.q, self.flight.v

    def advance(self, goal: int) -> int:
        """Call the kernel, up to step number `goal`; why it returned."""
        return int(self.run(self.flight, self.recorder.buffers, self.count, goal))

    def keep_now(self) -> None:
        """Write the current state into the recorder's buffers."""
        keep(self.flight, self.recorder.buffers, self.count, self.now)

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the flights that start there."""
        complete = self.kept.all or self.kept.on_events
        return Flights(without_impulses(s), complete, self.scene, (self.model, self.fast), self.start)


@dataclass(eq=False)
class Flights(BetweenByModel):
    """States between kept ones, in closed form."""

    start: Array  # constants and initial state of a flight

    def evaluate(self, times: Array, row: Any) -> tuple[Array, Array]:
        """The states, each from that row of the kept ones."""
        m, fast = self.model
        kernel = compiled(states_between) if fast else states_between
        out = Wanted(times, row, np.zeros((len(times), 1)), np.zeros((len(times), 1)))
        kernel(flight_of(self.scene, m, self.start.copy()), self.s, out)
        return out.q, out.v
