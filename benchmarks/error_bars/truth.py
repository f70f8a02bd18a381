"""What a run is held against: two motions by independent methods, as far as they agree.

The event-driven run at 1e-13, and `Located` in exact pieces, or of order 4 (2 with joints) at a small part of the
step; with dry friction, where bars come from the event-driven run, two runs of `Moreau` at a small part of the step,
theta = 1/2 and 1. A run is held against the one of the two that its bar does not come from; where their distance is
not small beside the error and the bar, the truth is not known.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmarks.judge.describe import Description
from lagrangian import Coulomb, LinearContacts
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.accuracy.errors import Difference, energies
from lcpstep.errorbar.bars import ErrorBar
from lcpstep.errorbar.companions import Companion
from lcpstep.errorbar.estimate import against
from lcpstep.errors import LcpStepError, SimulationInterrupted
from lcpstep.simulation import Method
from lcpstep.trajectory import Status, Trajectory

FINER = 24.0  # times more steps than a run
FINE, FINEST = 60.0, 90.0  # the same, with friction
MOST_STEPS = 100_000
SECONDS = 2.0  # of CPU time for a run
STEPS = (-0.7, 0.5)  # decades around the step that a scene asks for
TOLERANCES = (-10.0, -4.0)  # decades
MEASURES = ("position, sup", "velocity, L1", "velocity, sup", "impact times", "impulses", "energy, mean")
METHODS = ("Moreau", "Located, order 2", "Located, order 4", "EventDriven")
FRICTION = "Moreau, friction"
COEFFICIENTS = (0.05, 0.8)


@dataclass(frozen=True, eq=False)
class Truth:
    """Two motions, by the event-driven method and by steps."""

    by_events: Trajectory
    by_steps: Trajectory

    def of(self, run: Trajectory) -> Trajectory:
        """The motion that the bar of a run does not come from."""
        return self.by_steps if isinstance(run.method, (Moreau, Located)) else self.by_events


def within(scene: Any, method: Method, error: bool = False) -> Trajectory | None:
    """A run that is done in time, or None."""
    begin = time.process_time()

    def hurry(_: float) -> None:
        if time.process_time() - begin > SECONDS:
            raise KeyboardInterrupt

    try:
        run = simulate(scene, method, progress=hurry, error=error)
    except (LcpStepError, SimulationInterrupted):
        return None
    return run if run.status == Status.DONE else None


def truth(d: Description) -> Truth | None:
    """The two motions of a scene; None where a method does not reach the end."""
    scene = d.scene()
    by_events = within(scene, EventDriven(1e-13, 1e-13))
    h = max(d.h / FINER, d.length / MOST_STEPS)
    steps = [Located(min(2.0 * d.h, d.length / 8.0), "exact"), Located(h, 4), Located(h, 2)]
    by_steps = next((run for m in steps if (run := within(scene, m)) is not None), None)
    return None if by_events is None or by_steps is None else Truth(by_events, by_steps)


def rubbing(d: Description, rng: Any) -> Any:
    """The scene with dry friction along a random direction on each contact; None where it has none to rub along."""
    scene = d.scene()
    if d.n < 2 or not isinstance(scene.contacts, LinearContacts):
        return None
    G = np.array(d.G)
    T = rng.normal(size=G.shape)
    T -= (np.sum(T * G, axis=1) / np.sum(G * G, axis=1))[:, None] * G
    return replace(scene, contacts=replace(scene.contacts, friction=Coulomb(rng.uniform(*COEFFICIENTS), T)))


def truth_of_friction(scene: Any, h: float) -> Truth | None:
    """Two runs in far finer steps than h."""
    one, other = within(scene, Moreau(h / FINE)), within(scene, Moreau(h / FINEST, theta=1.0))
    return None if one is None or other is None else Truth(one, other)


def errors(run: Trajectory, reference: Trajectory, until: float) -> dict[str, float]:
    """Errors of a run up to a time: those of `lcpstep.accuracy.errors`, and of impacts that have partners."""
    apart = Difference(run, reference, t_end=until)
    seen = against(run, True, [(Companion(reference.method), reference)], until)
    values = (
        apart.sup_position, apart.l1_velocity, seen.velocity.sup, seen.latest, seen.strongest, apart.energy
    )  # fmt: skip
    return dict(zip(MEASURES, _zero_without_impacts(values), strict=True))


def _zero_without_impacts(values: tuple[float, ...]) -> list[float]:
    """What is not a number is an error of impacts that are not there."""
    return [0.0 if np.isnan(x) else float(x) for x in values]


def told(bar: ErrorBar) -> dict[str, float]:
    """The same as the bar says it."""
    length = bar.until - float(bar.t[0])
    values = (
        bar.position.sup, bar.velocity.l1, bar.velocity.sup, bar.latest, bar.strongest, bar.energy.l1 / length
    )  # fmt: skip
    return dict(zip(MEASURES, _zero_without_impacts(values), strict=True))


def sizes(run: Trajectory) -> dict[str, float]:
    """What the numbers of each measure are made of: beside it rounding is small."""
    q, v, t = (float(np.max(np.abs(x))) for x in (run.q, run.v, run.t))
    impulse = float(np.max(run.impacts["impulse"], initial=0.0))
    energy = float(np.max(np.abs(energies(run.scene, run.t, run.q, run.v))))
    return dict(zip(MEASURES, (q + v * t, v * t, v, t, impulse, energy), strict=True))


def step(d: Description, rng: Any) -> float:
    """A random step around the one that a scene asks for."""
    return float(min(d.h * 10.0 ** rng.uniform(*STEPS), d.length / 8.0))


def method_of(name: str, d: Description, rng: Any) -> Method:
    """A method with a step or tolerance drawn at random."""
    h = step(d, rng)
    tolerance = 10.0 ** rng.uniform(*TOLERANCES)
    return {
        "Moreau": Moreau(h),
        "Located, order 2": Located(h),
        "Located, order 4": Located(h, 4),
        "EventDriven": EventDriven(tolerance, tolerance),
    }[name]
