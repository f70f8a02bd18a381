"""Which run a run is held against: another method, more accurate, or where there is none another step.

    run                          companion                                          error of the run
    Moreau                       EventDriven, else Located of order 4               the distance
    Moreau, friction             Moreau at half the step (Richardson)               1.6 (2) times the distance
    Moreau by a tolerance        the same, at a tenth of the tolerance              the distance
    Located                      EventDriven, else Located of another order         the distance
    EventDriven                  Located "exact" where the motion has that form     the distance
    EventDriven, else            a far smaller tolerance; and `Located` looks       the distance
                                 whether it sees the same events

The distance is the error of the run as far as the companion's own error is smaller. Moreau's smooth steps are those
of `Located` of order 2, which is no companion for that reason; and a tolerance that is just a little smaller is none,
since something else keeps the steps of `EventDriven` short where it is loose. For two steps (L. F. Richardson, Phil.
Trans. R. Soc. A 210 (1911) 307) the error is twice the distance at order one, which impacts leave, and 4/3 at order
two, of theta = 1/2 between them: in the middle, the bar is right within 1.25 for both.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

from lagrangian import Scene
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.events import EventDriven
from lcpstep.events.driven import LEAST_TOLERANCE
from lcpstep.faults import forget
from lcpstep.recording import Kept
from lcpstep.stepping.located import Located, require_linear
from lcpstep.stepping.moreau import Moreau
from lcpstep.trajectory import Trajectory

KNOWN = (Moreau, Located, EventDriven)  # methods that have companions
BEST = EventDriven(1e-13, 1e-13)
TIGHTER = 0.1  # tolerance of a companion by the same method
FAR = 0.03  # the same of event-driven runs that are tighter than usual
BOTH_ORDERS = 1.6  # between 2 / (2 - 1) and 4 / (4 - 1)
PIECES = 4.0  # of order 4 in a step of the event-driven run
PATIENCE = 1.0  # that a companion may take in any case [s of CPU time]


@dataclass(frozen=True)
class Companion:
    """A method to hold a run against; the run's error is `factor` times the distance, or unknown for None.

    One with the factor None only says whether the same events are seen.
    """

    method: Any
    factor: float | None = 1.0


def companions(run: Trajectory) -> Iterator[tuple[Companion, ...]]:
    """Companions that a run may have, the best first; the first that treats the scene is taken."""
    method, scene = run.method, run.scene
    if isinstance(method, EventDriven):
        yield from _of_event_driven(method, scene, run)
        return
    yield (Companion(BEST),)
    if isinstance(method, Located):
        yield (Companion(Located(method.h, 2 if method.order == 4 else 4)),)
        return
    yield (Companion(Located(method.h, 4)),)
    if method.tolerance is None:
        factor = BOTH_ORDERS if method.theta == 0.5 else 2.0
        yield (Companion(replace(method, h=0.5 * method.h), factor),)
    else:
        yield (Companion(replace(method, tolerance=TIGHTER * method.tolerance)),)


def _of_event_driven(method: EventDriven, scene: Scene, run: Trajectory) -> Iterator[tuple[Companion, ...]]:
    step = float(run.t[-1] - run.t[0]) / max(run.counts.steps, 1)
    try:
        require_linear(scene)
        yield (Companion(Located(step, "exact")),)
    except LcpStepError:
        pass
    rtol, atol = (max(LEAST_TOLERANCE, min(BEST.rtol, x * FAR)) for x in (method.rtol, method.atol))
    order = 4 if scene.n_j == 0 else 2
    yield Companion(EventDriven(rtol, atol)), Companion(Located(step / PIECES, order), None)


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
    return found


def in_words(method: Any) -> str:
    """A method and what differs from its defaults."""
    own = [(f.name, getattr(method, f.name)) for f in fields(method) if getattr(method, f.name) != f.default]
    shown = ", ".join(f"{name}={x:.3g}" if isinstance(x, float) else f"{name}={x!r}" for name, x in own)
    return f"{type(method).__name__}({shown})"
