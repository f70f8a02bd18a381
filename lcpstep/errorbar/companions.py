"""Which run a run is held against: another method, more accurate.

    run                          companion                                          error of the run
    Moreau, Located              EventDriven                                        the distance
    EventDriven                  `Advancement` of an oscillator above a fixed       the distance
                                 obstacle; else Located, of order 2 where
                                 accelerations are constant, "exact" where the
                                 motion has that form
    EventDriven, else            a smaller tolerance; and `Located` looks whether   the distance
                                 it sees the same events, in finer steps if not

The distance is the error of the run as far as the companion's own error is smaller. Moreau's smooth steps are those
of `Located` of order 2, which is no companion for that reason; and a tolerance that is just a little smaller is none,
since something else keeps the steps of `EventDriven` short where it is loose. A companion at a tolerance that is
small beside what such runs are off mostly serves as well as the best, and in less time; it does where the distance
turns out to be far larger than its own tolerance (`Companion.tells`).
"""

from __future__ import annotations

import functools
import time
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene
from lcpstep.callbacks.faults import forget
from lcpstep.errorbar.advancement import Advancement, treats
from lcpstep.errorbar.bars import ErrorBar
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.events import EventDriven
from lcpstep.events.driven import LEAST_TOLERANCE
from lcpstep.recording import Kept
from lcpstep.stepping.again import Again
from lcpstep.stepping.located import Located, require_exact
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Trajectory

KNOWN = (Moreau, Located, EventDriven)  # methods that have companions
TIGHT = 1e-13
SMALL = 1e-2  # size of a motion below which an absolute tolerance is as many times smaller [m]
MODERATE = 1.0  # the same beside event-driven runs, whose own errors may be far below that [m]
NOTHING = 1e-12  # size of a motion that is none [m]
FIRST = {1: 1e-8, 2: 1e-10}  # tolerance by the order of steps, that their error is mostly large beside
FAR = 0.1  # the same of event-driven runs that are tighter than usual
LOOSEST, ENOUGH = 1e-8, 200.0  # tolerance of a companion, and how many times smaller than an error it is then
EARLY, CLEAR = 0.25, 100.0  # part of the bar, in which it is so many times a companion's tolerance
PIECES = (
    1.0,
    4.0,
)  # in a step of the event-driven run, of steps that look for its events: first, and at last
LONG, ROWS = 16.0, 4000  # steps of the event-driven run in an exact one, and such steps in a span at least
PATIENCE = 1.0  # that a companion may take in any case [s of CPU time]


@dataclass(frozen=True)
class Companion:
    """A method to hold a run against.

    measures : its distance is the error, or it only looks for the same events
    first : it may not be accurate enough for what it does, and the next one is
    seen : it keeps the states that are compared: those between its own ask for another run
    """

    method: Any
    measures: bool = True
    first: bool = False
    seen: bool = False

    def tells(self, run: Trajectory, bar: ErrorBar) -> bool:
        """Whether it is accurate enough for the bar that it is part of.

        It sees the same events; or the bar is far above its own tolerance, early on, where no error has grown yet.
        """
        if not self.first:
            return True
        if not self.measures:
            return in_words(self.method) not in bar.reason
        early = int(np.searchsorted(bar.t, bar.t[0] + EARLY * (bar.t[-1] - bar.t[0]), side="right")) - 1
        own = self.method.rtol * _size(run)
        return bool(np.max(bar.position.largest[early]) > CLEAR * own)


def _size(run: Trajectory) -> float:
    """What a tolerance, absolute and relative, means for a run."""
    return 1.0 + max(float(np.max(np.abs(x))) for x in (run.q, run.v))


def best(run: Trajectory) -> EventDriven:
    """The tightest companion."""
    return EventDriven(TIGHT, _absolute(run))


def _absolute(run: Trajectory, small: float = SMALL) -> float:
    """The tightest absolute tolerance, which beside a small motion has to be small too [m]."""
    size = float(np.max(np.abs(run.q)))
    return TIGHT * min(1.0, size / small) if size > NOTHING else TIGHT


def companions(run: Trajectory, error: float | None = None) -> Iterator[tuple[Companion, ...]]:
    """Companions that a run may have, the best first; the first that treats the scene is taken.

    error : of the run, early on, where it is known [m]
    """
    method, scene = run.method, run.scene
    if isinstance(method, EventDriven):
        yield from _of_event_driven(method, scene, run)
        return
    order = getattr(method, "order", 1)
    loose = FIRST.get(order, 0.0) if error is None else min(LOOSEST, error / (ENOUGH * _size(run)))
    if loose > TIGHT and not in_closed_form(scene):
        yield (Companion(EventDriven(loose, loose), first=True),)
    yield (Companion(best(run)),)


def _of_event_driven(method: EventDriven, scene: Scene, run: Trajectory) -> Iterator[tuple[Companion, ...]]:
    span = float(run.t[-1] - run.t[0])
    step = span / max(run.counts.steps, 1)
    if treats(scene):
        yield (Companion(Advancement(), seen=True),)
    try:
        require_exact(scene)
        long = max(step, min(LONG * step, span / ROWS))
        yield (Companion(Located(long, 2 if _constant(scene) else "exact"), seen=True),)
    except LcpStepError:
        pass
    order = 4 if scene.n_j == 0 else 2
    # As tight as may be, the absolute one tighter: with that which the run has, a companion strikes the same together
    measure = Companion(
        EventDriven(
            max(LEAST_TOLERANCE, min(TIGHT, method.rtol * FAR)),
            min(_absolute(run, MODERATE), method.atol * FAR),
        )
    )
    for pieces in PIECES:
        looks = Companion(Located(step / pieces, order), measures=False, first=pieces < PIECES[-1])
        yield measure, looks


def in_closed_form(scene: Scene) -> bool:
    """Whether an event-driven run moves in closed form: a looser tolerance makes it no faster."""
    s, c = scene.system, scene.contacts
    known = isinstance(s, LinearSystem) and isinstance(s.force, Harmonic) and scene.n_j == 0
    if not known or not (c is None or (isinstance(c, LinearContacts) and c.friction is None)):
        return False
    return (scene.n_q == 1 and scene.n_c <= 1) or _constant(scene)


def _constant(scene: Scene) -> bool:
    """Whether the accelerations of a linear system are constant, and its obstacles stand still."""
    s: Any = scene.system
    c: Any = scene.contacts
    moves = s.frame is not None or (c is not None and c.motion is not None)
    turns = s.force.omega != 0.0 and any(np.any(x) for x in s.force.terms(scene.n_q)[1:])
    return not (moves or turns or any(abs(x).max() > 0.0 for x in (s.C, s.K)))


def followed(companion: Companion, scene: Scene, kept: Kept, seconds: float) -> Trajectory | None:
    """The companion's run, as far as it comes within its CPU time; None where it does not treat the scene."""
    begin, late = time.process_time(), False

    def hurry(_: float) -> None:
        nonlocal late
        late = time.process_time() - begin > max(seconds, PATIENCE)
        if late:
            raise KeyboardInterrupt

    method, span = companion.method, scene.t_span[1] - scene.t_span[0]
    if getattr(method, "h", 0.0) > span:
        method = replace(method, h=span)
    try:
        found: Trajectory = method.run(scene, kept, hurry)
    except SimulationInterrupted as stopped:
        if not late:
            raise
        found = replace(stopped.trajectory, message="for it takes longer than the run")
    except SimulationError as error:
        found = error.trajectory
    except LcpStepError:
        return None
    finally:
        forget()
    if companion.seen and len(found.t):  # what else is asked for are no differences of positions kept
        found = replace(found, dense=Again(method, scene, found.q[-1], found.v[-1]))
    return found


@functools.lru_cache(maxsize=64)
def in_words(method: Any) -> str:
    """A method and what differs from its defaults."""
    own = [(f.name, getattr(method, f.name)) for f in fields(method) if getattr(method, f.name) != f.default]
    shown = ", ".join(f"{name}={x:.3g}" if isinstance(x, float) else f"{name}={x!r}" for name, x in own)
    return f"{type(method).__name__}({shown})"
