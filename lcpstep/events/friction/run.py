"""Runs of systems with planar friction, event by event."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.events import running
from lcpstep.events.friction.loop import Course
from lcpstep.events.friction.smooth import Smooth
from lcpstep.events.general.ends import NO_FORCES, NO_IMPULSES
from lcpstep.events.general.run import FIRST_STEP, QUADRATURE, Moved, recorder_for
from lcpstep.events.scan import scan_interval
from lcpstep.gauss import gauss
from lcpstep.kernels.clock import Clock
from lcpstep.model import coefficients, models
from lcpstep.recording import Kept, States
from lcpstep.trajectory import Status
from lcpstep.turns import turns

Array = NDArray[np.float64]


def start(
    scene: Scene,
    kind: Callable[..., Any],
    rtol: float,
    atol: float,
    *more: Any,
    yields: bool = False,
) -> Any:
    """The state at the start of the span, of that kind of motion, which may ask for more than tolerances.

    yields : whether sliding that jams ends in an impact
    """
    contacts, joints, tangents = models(scene)
    given: Any = scene.contacts
    friction = given and given.friction
    tangential = np.zeros(scene.n_c) if friction is None else friction.tangential(given.restitution)
    scan = scan_interval(scene, contacts, 0.0)
    clock = Clock(scene.t_span, turns(scene, with_belts=True).stops, scene.period)
    s = kind(
        contacts, joints, tangents, coefficients(scene), tangential,
        friction is not None and friction.law == "stronge", yields, clock, scene.t_span[1], scan, rtol, atol,
        *gauss(QUADRATURE), *more,
    )  # fmt: skip
    s.state[: scene.n_q], s.state[scene.n_q :] = scene.q0, scene.v0
    s.next_step = FIRST_STEP * scan
    return s


class FrictionRun(running.EventRun):
    """A run with contacts that stick and slide."""

    def __init__(self, method: Any, scene: Scene, kept: Kept) -> None:
        self.system = self.start(scene, method)
        recorder = recorder_for(scene, kept, 2 * scene.n_c + scene.n_j, False)
        super().__init__(method, scene, kept, recorder)
        self.course = Course(self.system, recorder.record, self.tally)

    def start(self, scene: Scene, method: Any) -> Any:
        """The motion at the start of the span."""
        return start(scene, Smooth, method.rtol, method.atol, yields=method.jamming == "impact")

    @property
    def now(self) -> float:
        """Time reached [s]."""
        return float(self.system.clock.t0)

    @property
    def interval_end(self) -> float:
        """End of the interval at hand [s]."""
        return min(self.system.t_end, self.now + self.system.scan_length)

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        q, v = np.split(self.system.state, 2)
        return q, v

    @property
    def evaluations(self) -> int:
        """How often forces were evaluated."""
        return int(self.system.evaluations)

    def dense(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the motion from each to the next."""
        return Moved(running.without_impulses(s), self.kept.all, False, self.recorder.dense())

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        said, times = super().message(code), self.system.jams
        if times == 0:
            return said
        often = f"{times} time{'s' * (times > 1)}"
        return f"{said}; sliding jammed {often} and ended in impacts without collision (Kind.JAM)"

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        closed, where = self.system.closed_ones(), self.where
        if code == NO_IMPULSES:
            return f"no impulses of the contacts {closed} end their approach {where}"
        if code == NO_FORCES:
            return f"no forces of the closed contacts {closed} keep them from passing {where}"
        if code in (Status.PAINLEVE_INCONSISTENT, Status.PAINLEVE_INDETERMINATE):
            return f"{self.paradox(code)} {where}"
        if code == Status.NOT_FINITE and self.system.coefficients.fault():
            return f"{self.system.coefficients.fault()} {where}"
        return f"{super().why(code)}; closed contacts {closed}"

    def paradox(self, code: int) -> str:
        """Painleve's paradox in words: the contact, and the coefficient of friction from which on it occurs."""
        c = int(self.system.culprit)
        mu, critical = self.system.coefficient(c), self.system.critical_friction(c)
        alone = critical > 0.0 and mu >= (1.0 - 1e-9) * critical
        limit = f" (critical at this state: {critical:.9g})" if alone else " beside what else is held"
        words = {
            Status.PAINLEVE_INCONSISTENT: "no force keeps it from passing the surface",
            Status.PAINLEVE_INDETERMINATE: "it may as well stay closed as open",
        }[Status(code)]
        return f"contact {c} slides with mu = {mu:g}{limit}, and {words}"
