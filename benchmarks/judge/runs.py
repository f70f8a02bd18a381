"""One run of one method on one scene: what is asked, and how it ended."""

from __future__ import annotations

import importlib
import signal
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from benchmarks.judge.describe import Description
from benchmarks.judge.scales import Scales, scales
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.errors import LcpStepError, SimulationError

# Methods load their runs when they run: here at once, for no scene's bound has room for that
for kernels in ("events.flight.run", "events.parabolas.run", "stepping.moreau_run", "stepping.pieces.run"):
    importlib.import_module(f"lcpstep.{kernels}")

MAX_EVENTS = 50_000
CPU_EACH = 1e-4  # seconds of each step and event
REFERENCE = "event-driven"
DOUBT, SAID = (
    "doubt",
    "said: ",
)  # ending of a run that says that it is wrong; before the kinds of what is found


class Finding(NamedTuple):
    """Something that is not as it has to be."""

    method: str
    kind: str
    text: str


def silent(kind: str) -> bool:
    """Whether a run in which this was found has not said so."""
    return not kind.startswith(SAID)


class Hung(Exception):
    """A run that has used its CPU time and has hardly come on."""


class Clock:
    """Bound on the CPU time of one run, which is interrupted; where machine code hears nothing, the process ends.

    A run by a tolerance takes as many steps as it needs, which nobody knows before: it is cut short, and no more,
    if it has come on by steps and events that are worth the time.
    """

    limit = 0.0  # seconds of a run, and of every so many steps of a long one; 0: none
    steps = 1e5
    evaluations = 0  # of forces by the reference: as many steps may be asked for by a tolerance
    longest = 2.0  # times the limit of a run by a tolerance: it keeps up to 1e7 states in a second
    deaf = 2.0  # seconds that it may take to hear the interrupt

    def __init__(self, steps: float, chosen: bool = False) -> None:
        """`chosen`: whether the steps are, by a tolerance."""
        asked = max(1.0, steps / Clock.steps, Clock.evaluations / Clock.steps)
        self.seconds, self.rang = Clock.limit * (min(asked, Clock.longest) if chosen else asked), False

    def __enter__(self) -> Clock:
        if Clock.limit:
            signal.signal(signal.SIGPROF, self.ring)
            signal.setitimer(signal.ITIMER_PROF, self.seconds)
            signal.setitimer(signal.ITIMER_VIRTUAL, self.seconds + self.deaf)
        return self

    def ring(self, *_: object) -> None:
        """Interrupt the run."""
        self.rang = True
        raise KeyboardInterrupt

    def __exit__(self, *error: object) -> None:
        if Clock.limit:
            signal.setitimer(signal.ITIMER_PROF, 0.0)
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)


@dataclass(frozen=True)
class Way:
    """A method as the judge asks it: made for a step h and a factor on its step or tolerance."""

    make: Callable[[float, float], Any]
    order: float  # at which its error goes down with the factor
    code: str  # what makes it, for the reproduction
    tolerance: float = 0.0


N = MAX_EVENTS
WAYS = {
    "event-driven": Way(lambda h, f: EventDriven(1e-12 * f, 1e-12 * f, N), 1, "EventDriven()", 1e-12),
    "event-driven-loose": Way(
        lambda h, f: EventDriven(1e-6 * f, 1e-6 * f, N), 1, "EventDriven(1e-6, 1e-6)", 1e-6
    ),
    "located": Way(lambda h, f: Located(h * f, max_events=N), 2, "Located({h})"),
    "located-4": Way(lambda h, f: Located(h * f, 4, N), 4, "Located({h}, 4)"),
    "located-exact": Way(lambda h, f: Located(h * f, "exact", N), 9, 'Located({h}, "exact")'),
    "located-tolerance": Way(
        lambda h, f: Located(8 * h, 2, N, tolerance=1e-4 * f),
        1,
        "Located(8 * {h}, tolerance=1e-4)",
        1e-4,
    ),
    "located-4-tolerance": Way(
        lambda h, f: Located(8 * h, 4, N, tolerance=1e-6 * f),
        1,
        "Located(8 * {h}, 4, tolerance=1e-6)",
        1e-6,
    ),
    "moreau": Way(lambda h, f: Moreau(h * f), 1, "Moreau({h})"),
    "moreau-tolerance": Way(
        lambda h, f: Moreau(8 * h, tolerance=1e-2 * f), 1, "Moreau(8 * {h}, tolerance=1e-2)", 1e-2
    ),
}


@dataclass(frozen=True)
class Run:
    """How a run went: DONE, another status, "refused" or "cut short"; `motion` is what there is of it."""

    method: str
    status: str
    text: str
    motion: Any
    cpu: float

    @property
    def done(self) -> bool:
        """Whether it reached the end of the span."""
        return self.status == "DONE"

    @property
    def usable(self) -> bool:
        """Whether there is a motion to look at."""
        return self.motion is not None and len(self.motion.t) > 1 and bool(np.all(np.isfinite(self.motion.q)))

    @property
    def doubt(self) -> str:
        """What it says itself of its being wrong, or nothing."""
        return "" if self.motion is None else str(self.motion.doubt)

    @property
    def ending(self) -> str:
        """Its status; DOUBT where it reached the end and says that it is wrong."""
        return DOUBT if self.done and self.doubt else self.status

    @property
    def tolerance(self) -> float:
        """What the method promises, 0 where it takes steps of one size."""
        return WAYS[self.method].tolerance

    def scales(self, d: Description) -> Scales:
        """Sizes of the motion, worked out once."""
        if not hasattr(self, "_scales"):
            object.__setattr__(self, "_scales", scales(d, self.motion.q, self.motion.v))
        return self._scales  # type: ignore[attr-defined, no-any-return]

    @cached_property
    def _known(self) -> dict[bytes, Any]:
        """States by the times that they were asked for at."""
        return {}

    def at(self, times: Any) -> Any:
        """States at an array of times, as `motion.at` tells them; what was asked for before is remembered."""
        key = times.tobytes()
        if key not in self._known:
            self._known[key] = self.motion.at(times)
        return self._known[key]

    def ask(self, *several: Any) -> None:
        """Have states at several arrays of times at once, for `at`, where one look is dear: it is another run."""
        if not getattr(self.motion.dense, "dear", False):
            return
        try:
            q, v = self.motion.at(np.concatenate(several))
        except (IndexError, ValueError):  # `at` says of which times
            return
        ends = np.cumsum([len(times) for times in several])[:-1]
        for times, *states in zip(several, np.split(q, ends), np.split(v, ends), strict=True):
            self._known[times.tobytes()] = tuple(states)


def run(d: Description, name: str, factor: float = 1.0, keep: Any = 1) -> Run:
    """One run; an exception that the library does not announce is an ending of its own, "raised"."""
    scene, way = d.scene(), WAYS[name]
    clock = Clock(d.length / (d.h * factor), way.tolerance > 0.0)
    started = time.process_time()
    try:
        with clock:
            motion = simulate(scene, way.make(d.h, factor), keep=keep)
    except KeyboardInterrupt as interrupt:
        if not clock.rang:
            raise
        return _cut_short(name, getattr(interrupt, "trajectory", None), _since(started))
    except SimulationError as error:
        return Run(name, error.trajectory.status.name, str(error), error.trajectory, _since(started))
    except LcpStepError as error:
        return Run(name, "refused", str(error), None, _since(started))
    except Exception as error:  # whatever it is, it is reported
        return Run(name, "raised", f"{type(error).__name__}: {error}", None, _since(started))
    return Run(name, motion.status.name, motion.message, motion, _since(started))


def _cut_short(name: str, motion: Any, cpu: float) -> Run:
    """A run whose time was up; Hung where it has not come on."""
    work = 0 if motion is None else motion.counts.steps + motion.counts.events
    if cpu > CPU_EACH * work:
        raise Hung(f"{work} steps and events within {cpu:.3g} s of CPU time")
    return Run(name, "cut short", f"after {work} steps and events", None, cpu)


def _since(started: float) -> float:
    return time.process_time() - started


def lines(d: Description, name: str) -> str:
    """The few lines that reproduce a run."""
    method = WAYS[name].code.format(h="d.h")
    return (
        f"from {type(d).__module__} import {type(d).__name__}\n"
        "from lcpstep import EventDriven, Located, Moreau, simulate\n"
        f"d = {d!r}\nmotion = simulate(d.scene(), {method})"
    )
