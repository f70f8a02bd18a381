"""What the maps from event to event share: points that begin with the phase of the forcing, and waiting for an event.

With J = DP at a fixed time and t_x the derivative of the time of the event, a point (phase, x) of a scene with the
rate w = 2 pi / T of its forcing has the derivative

    [ -t_x F    w t_x ]
    [ -J F / w    J   ]        F = x' at the start,

as a later start is one from a state that lies back along the motion. Source: G. Osorio, Complex Behavior in Impacting
Systems, sections 2.8.2 and 3.2.3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven

Array = NDArray[np.float64]
TWO_PI = 2.0 * math.pi
SPANS = 20.0  # of the scene: the longest that is waited for an event, where not given
FEW, MORE = 16, 16  # events that are looked at first, and how many times as many each time after


class NoReturn(LcpStepError):
    """A motion that did not come back to its section within the time limit; the point is in `x`."""

    def __init__(self, x: Array, limit: float, event: str = "impact") -> None:
        super().__init__(f"no {event} within {limit:g} s after the one at x = {x.tolist()}")
        self.x = x


def is_driven(scene: Scene | HybridScene) -> bool:
    """Whether points begin with the phase of the forcing."""
    return math.isfinite(scene.period)


def limit_of(scene: Scene | HybridScene, limit: float | None) -> float:
    """The longest to wait for an event: as given, or by the length of the scene's span."""
    span = scene.t_span[1] - scene.t_span[0]
    return SPANS * span if limit is None else checks.positive("limit", limit)


def time_of(phase: float, scene: Scene | HybridScene) -> float:
    """Time within the first period [s]."""
    return (phase % TWO_PI) / TWO_PI * scene.period


def phase_of(time: float, scene: Scene | HybridScene) -> float:
    """Phase within its period [rad]."""
    return TWO_PI * (time / scene.period % 1.0)


def waits(first: float, limit: float) -> Iterator[float]:
    """Spans in which an event is looked for, each twice as long as the last; the limit ends them."""
    wait = min(first, limit)
    yield wait
    while wait < limit:
        wait = min(2.0 * wait, limit)
        yield wait


def bounded(method: EventDriven) -> Iterator[EventDriven]:
    """The method with bounds of the number of events, each several times the last, up to its own.

    A span holds many more events than the one that is looked for, where that comes early.
    """
    most = FEW
    while most < method.max_events:
        yield replace(method, max_events=most)
        most *= MORE
    yield method


def with_phase(scene: Scene | HybridScene, J: Array, t_x: Array, t_start: float, moved: Array) -> Array:
    """The derivative of (phase, x), from that of x at a fixed time: see the head of this file.

    t_start : t_x F; moved : J F
    """
    rate = TWO_PI / scene.period
    return np.block([
        [np.atleast_2d(-t_start), rate * t_x[None, :]],
        [-moved[:, None] / rate, J],
    ])  # fmt: skip
