"""Several methods on one scene, side by side: error, CPU time and impacts of each, and what accuracy costs.

    error = max over time and coordinates of |q - q_ref|

at equally spaced times. The reference is the motion in closed form where the scene has one, else `EventDriven` with a
tenth of the tolerance, else (friction) `Moreau` with a sixteenth of the step. What a method does not treat is left
out, with its reason.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lagrangian.labels import units
from lcpstep.accuracy import dials
from lcpstep.accuracy.dials import changeable, dial, with_value
from lcpstep.accuracy.question import curves_of
from lcpstep.errors import LcpStepError, SimulationError
from lcpstep.events import EventDriven
from lcpstep.events.driven import LEAST_TOLERANCE
from lcpstep.simulation import Method, fitted, simulate
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
Progress = Callable[[float], None]
LOOKS = 2001  # instants of the span at which positions are compared
FIRST_IMPACTS = 3
COARSER = (4.0, 16.0, 64.0)  # further steps, in those of a method
FEWEST = 20  # of these in the span
SPREAD = (0.87, 1.0, 1.15)  # nearby steps that these are averaged over: one alone scatters by a factor of ten
LOOSER = (1e-4, 1e-6, 1e-8, 1e-10)  # further tolerances
# Runs shorter than that [s of CPU time] are timed again, so often, and the shortest counts: the first one on a
# machine reads modules as well
BRIEF, REPEATS = 0.2, 3
FINER = 16.0  # steps of a reference by time-stepping


@dataclass(frozen=True)
class Level:
    """What a method reached at one step or tolerance: error [m] and CPU time [s]."""

    value: float
    error: float
    seconds: float


@dataclass(frozen=True, eq=False)
class Entrant:
    """One method.

    Attributes
    ----------
    name, method : as the table calls it
    run : Trajectory at the instants compared, or None where the method refuses the scene, for `reason`
    seconds : CPU time of the run
    apart : (m,) distance from the reference at the run's times, the largest of all coordinates [m]
    levels : further steps or tolerances, coarse to fine, this one included
    """

    name: str
    method: Any
    run: Trajectory | None = None
    seconds: float = 0.0
    apart: Array = field(default_factory=lambda: np.zeros(0))
    levels: tuple[Level, ...] = ()
    reason: str = ""

    @property
    def error(self) -> float:
        """Largest distance from the reference [m]."""
        return float(np.max(self.apart, initial=0.0))

    @property
    def impacts(self) -> Array:
        """Times of the impacts [s]."""
        log = None if self.run is None else self.run.impacts
        return np.zeros(0) if log is None else np.asarray(log.time[log.kind == Kind.IMPACT], dtype=float)

    def agrees_until(self, distance: float) -> float:
        """Time from which on it has been further away than that [s]; the end where it never was."""
        t = np.zeros(1) if self.run is None else self.run.t
        far = np.flatnonzero(self.apart > distance)
        return float(t[far[0]] if len(far) else t[-1])


@dataclass(frozen=True, eq=False)
class Contest:
    """Several methods on one scene.

    Attributes
    ----------
    t : (n,) instants; q : (n, n_q) the reference there
    reference : what it is, in words
    entrants : the methods, refused ones included
    """

    scene: Scene
    t: Array
    q: Array
    reference: str
    entrants: tuple[Entrant, ...]

    @property
    def unit(self) -> str:
        """Unit of the coordinates, where they have one in common."""
        return units(self.scene.labels)[0]

    @property
    def runs(self) -> list[Entrant]:
        """Those that ran."""
        return [x for x in self.entrants if x.run is not None]

    def first_impacts_off(self, entrant: Entrant) -> float | None:
        """Largest error of the first impact times [s], against the event-driven ones; None without these."""
        known = next((x for x in self.runs if isinstance(x.method, EventDriven)), None)
        if known is None or known is entrant:
            return None
        k = min(FIRST_IMPACTS, len(known.impacts), len(entrant.impacts))
        return float(np.max(np.abs(entrant.impacts[:k] - known.impacts[:k]), initial=0.0)) if k else None


def contest(scene: Scene, methods: Sequence[Method], progress: Progress | None = None) -> Contest:
    """Run every method, and find what it costs.

    Parameters
    ----------
    scene : lagrangian.Scene
    methods : for example [Moreau(1e-4), Located(1e-4), EventDriven()]
    progress : called now and then with the time that a run has reached [s]

    Raises
    ------
    ValueError, TypeError   no methods, or what is none
    LcpStepError   no method treats the scene
    Everything that `lcpstep.simulate` raises about a run.
    """
    checks.instance("scene", scene, Scene)
    curves_of(methods)  # which refuses what is no method, and none at all
    tell = progress or (lambda t: None)
    t = np.linspace(*scene.t_span, LOOKS)
    reasons = {k: _refused(scene, method) for k, method in enumerate(methods)}
    if all(reasons.values()):
        raise LcpStepError(f"no method treats {scene.name!r}: {'; '.join(reasons.values())}")
    words, q = _reference(scene, methods, t, tell)
    entrants = tuple(
        Entrant(_name(method), method, reason=reasons[k])
        if reasons[k]
        else _entrant(scene, method, t, q, tell)
        for k, method in enumerate(methods)
    )
    return Contest(scene, t, q, words, entrants)


def _entrant(scene: Scene, method: Method, t: Array, q: Array, tell: Progress) -> Entrant:
    """One method at its own setting and at coarser ones."""
    run, seconds = _timed(scene, method, t, tell)
    apart = np.max(np.abs(run.q - q[: len(run.t)]), axis=1)
    levels = (
        [Level(dial(method)[1], float(np.max(apart, initial=0.0)), seconds)] if changeable(method) else []
    )
    for near in _coarser(method, float(np.ptp(scene.t_span))):
        try:
            found = [_timed(scene, other, t, tell) for other in near]
        except SimulationError:  # a step too long for this motion has no error to show
            continue
        errors = [float(np.max(np.abs(x.q - q[: len(x.t)]), initial=0.0)) for x, _ in found]
        if all(len(x.t) == len(t) for x, _ in found):
            cost = float(np.mean([s for _, s in found]))
            levels.append(Level(dial(near[len(near) // 2])[1], float(np.mean(errors)), cost))
    return Entrant(_name(method), method, run, seconds, apart, tuple(sorted(levels, key=lambda x: -x.value)))


def _timed(scene: Scene, method: Any, t: Array, tell: Progress) -> tuple[Trajectory, float]:
    """A run that keeps the instants, and its CPU time."""
    run, seconds = _clocked(lambda: simulate(scene, method, keep=t, progress=tell))
    if seconds < BRIEF:  # so that what is kept does not count, nor what else the machine does
        seconds = min(_clocked(lambda: simulate(scene, method, keep=t[-1:]))[1] for _ in range(REPEATS))
    return run, seconds


def _clocked(what: Callable[[], Trajectory]) -> tuple[Trajectory, float]:
    start = time.process_time()
    return what(), time.process_time() - start


def _coarser(method: Any, span: float) -> list[list[Any]]:
    """Further levels of a method, each a few nearby steps, or one tolerance."""
    if not changeable(method):
        return []
    which, value = dial(method)
    if which == "h":
        steps = [value * k for k in COARSER if value * k * FEWEST <= span]
        return [[with_value(method, h * s) for s in SPREAD] for h in steps]
    return [[with_value(method, x)] for x in LOOSER if x > value]


def _refused(scene: Scene, method: Method) -> str:
    """Why a method does not treat a scene; "" where it does. Callbacks are compiled on the way."""
    start, end = scene.t_span
    short = replace(scene, t_span=(start, start + 1e-6 * (end - start)))
    try:
        simulate(short, fitted(method, short.t_span))
    except LcpStepError as error:
        if hasattr(error, "trajectory"):  # it has run, and failed
            raise
        return str(error)
    return ""


def _reference(scene: Scene, methods: Sequence[Any], t: Array, tell: Progress) -> tuple[str, Array]:
    """What the motion is, and its positions."""
    if scene.exact is not None:
        return "the motion in closed form", np.asarray(scene.exact(t)[0])
    tolerance = min((m.rtol for m in methods if isinstance(m, EventDriven)), default=1e-12)
    tight = EventDriven(max(0.1 * tolerance, LEAST_TOLERANCE), max(0.1 * tolerance, LEAST_TOLERANCE))
    if not _refused(scene, tight):
        run = simulate(scene, tight, keep=t, progress=tell)
        words = f"event-driven at a tolerance of {tight.rtol:.0e}"
    else:
        h = min((m.h for m in methods if isinstance(m, Moreau)), default=1e-4) / FINER
        run = simulate(scene, Moreau(h), keep=t, progress=tell)
        words = (
            f"Moreau at h = {h:.3g} s, for nothing better treats this scene: errors near its own are its own"
        )
    if len(run.t) < len(t):
        raise LcpStepError(f"reference: {words} ended early: {run.message}")
    return words, run.q


def _name(method: Any) -> str:
    """As a table has room for: "Located, order 4"."""
    order = getattr(method, "order", None)
    return dials.label(method) if order is None else f"{type(method).__name__}, order {order}"
