"""What a run is held against: two motions by independent methods, as far as they agree.

The event-driven run at 1e-13, and `Located` in exact pieces, or of order 4 (2 with joints) at a small part of the
step; with dry friction `Moreau` at a small part of the step. A run is held against the one of the two that its bar
does not come from; where their distance, with the eyes of the run, is not small beside the error and the bar, the
truth is not known.

Errors of event-driven runs with friction are below what any steps can show: they are held against such a run at
1e-12, where `Moreau` sees the same events and the same motion to a share of its size.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.judge.describe import Description
from lagrangian import Coulomb, LinearContacts
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.accuracy.errors import Difference, energies
from lcpstep.errorbar.bars import ErrorBar
from lcpstep.errorbar.breaks import with_nodes
from lcpstep.errorbar.companions import Companion
from lcpstep.errorbar.curves import merged
from lcpstep.errorbar.curves import within as inside
from lcpstep.errorbar.distance import fall
from lcpstep.errorbar.estimate import against, resolved
from lcpstep.errorbar.looks import looks
from lcpstep.errors import LcpStepError, SimulationInterrupted
from lcpstep.model import model
from lcpstep.simulation import Method
from lcpstep.trajectory import Status, Trajectory

FINER = 24.0  # times more steps than a run
FINE = 60.0  # the same, with friction
MOST_STEPS = 100_000
SECONDS = 2.0  # of CPU time for a run
STEPS = (-0.7, 0.5)  # decades around the step that a scene asks for
TOLERANCES = (-10.0, -4.0)  # decades
MEASURES = ("position, sup", "velocity, L1", "velocity, sup", "impact times", "impulses", "energy, mean")
METHODS = ("Moreau", "Located, order 2", "Located, order 4", "EventDriven")
FRICTION = ("Moreau, friction", "EventDriven, friction")
TIGHT, LESS_TIGHT = EventDriven(1e-13, 1e-13), EventDriven(1e-12, 1e-12)
SEEN = 0.02  # of the range of a motion with friction, that steps may be off where they are to confirm it
COEFFICIENTS = (0.05, 0.8)


@dataclass(frozen=True, eq=False)
class Truth:
    """Two motions, by the event-driven method and by steps; with friction one by events at another tolerance."""

    by_events: Trajectory
    by_steps: Trajectory
    less_tight: Trajectory | None = None

    def told(self, run: Trajectory) -> tuple[Errors, dict[str, float]]:
        """Errors of a run until its bar ends, and how far they may be off themselves."""
        until, steps = run.error.until, isinstance(run.method, (Moreau, Located))
        best = self.by_steps if steps else self.less_tight or self.by_events
        check = self.by_steps if best is self.by_events else self.by_events
        unsure = errors(best, check, until, resolved(run) if steps else None).of
        own = errors(run, best, until)
        free = away_from_impacts(run, best, unsure["impact times"])
        own.of["velocity, sup"], unsure["velocity, sup"] = (
            fastest(run, best, free),
            fastest(best, check, free),
        )
        if best is self.less_tight and self.confirmed < until:
            unsure = dict.fromkeys(unsure, np.inf)
        return own, unsure

    @cached_property
    def confirmed(self) -> float:
        """Until when steps see the events of the event-driven run, and its motion roughly [s]."""
        seen = against(self.by_steps, True, [(Companion(TIGHT), self.by_events)])
        far = np.max(seen.position.largest, axis=1) > SEEN * np.max(np.ptp(self.by_events.q, axis=0))
        return float(min(seen.until, seen.t[np.argmax(far)] if np.any(far) else np.inf))


class Errors(NamedTuple):
    """Errors by measure, and the impacts (n_events,) of the run whose errors are known."""

    of: dict[str, float]
    known: NDArray[np.bool_]


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
    by_events = within(scene, TIGHT)
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
    """By events at two tolerances, and in far finer steps than h."""
    by_events, less_tight = within(scene, TIGHT), within(scene, LESS_TIGHT)
    finest = float(scene.t_span[1] - scene.t_span[0]) / MOST_STEPS
    by_steps = within(scene, Moreau(max(h / FINE, finest)))
    if by_events is None or less_tight is None or by_steps is None:
        return None
    return Truth(by_events, by_steps, less_tight)


def errors(run: Trajectory, reference: Trajectory, until: float, resolution: float | None = None) -> Errors:
    """Errors of a run up to a time: those of `lcpstep.accuracy.errors`, and of impacts that have partners."""
    apart = Difference(run, reference, t_end=until)
    seen = against(run, True, [(Companion(reference.method), reference)], until, resolution)
    known = np.isfinite(seen.impact_time) & (run.error is None or np.isfinite(run.error.impact_time))
    smooth = (apart.sup_position, apart.l1_velocity, seen.velocity.sup, apart.energy)
    return Errors(_by_name(smooth, seen, known), known)


def away_from_impacts(run: Trajectory, reference: Trajectory, margin: float) -> NDArray[np.float64]:
    """Times about which the bar of a run says something of velocities, as far as impacts of the truth are known."""
    t = with_nodes(looks(run, reference, True, run.error.until).t)
    t = np.unique(t[t <= run.error.until])
    return t[~inside(merged(run.error.left_out, margin), t)]


def fastest(run: Trajectory, reference: Trajectory, t: NDArray[np.float64]) -> float:
    """The largest difference of velocities at some times."""
    return float(np.max(np.abs(run.at(t)[1] - reference.at(t)[1]), initial=0.0)) if len(t) else 0.0


def told(bar: ErrorBar, known: NDArray[np.bool_]) -> dict[str, float]:
    """The same as the bar says it, of impacts that the truth knows too."""
    length = bar.until - float(bar.t[0])
    return _by_name((bar.position.sup, bar.velocity.l1, bar.velocity.sup, bar.energy.l1 / length), bar, known)


def _by_name(smooth: tuple[float, ...], of: ErrorBar, known: NDArray[np.bool_]) -> dict[str, float]:
    *motion, energy = smooth
    impacts = (np.max(x[known], initial=0.0) for x in (of.impact_time, of.impact_impulse))
    return dict(zip(MEASURES, map(float, (*motion, *impacts, energy)), strict=True))


def sizes(run: Trajectory) -> dict[str, float]:
    """What the numbers of each measure are made of, also where forces cancel: beside it rounding is small."""
    q, v, t = (float(np.max(np.abs(x))) for x in (run.q, run.v, run.t))
    v = max(v, fall(model(run.scene), run))
    impulse = float(np.max(run.impacts["impulse"], initial=0.0))
    states = ((run.t, run.q, run.v), (run.t[:1], run.q[:1], np.full((1, run.scene.n_q), v)))
    energy = max(float(np.max(np.abs(energies(run.scene, *x)))) for x in states)
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
