"""Runs of systems with contacts and joints, with planar friction or without, event by event."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.events.codes import NO_SURFACE
from lcpstep.events.contacts.loop import Course
from lcpstep.events.contacts.smooth import Smooth
from lcpstep.events.rows.contacts import Contacts
from lcpstep.events.running import FIRST_STEP, Integrated
from lcpstep.events.scan import scan_interval
from lcpstep.kernels.function import Functions
from lcpstep.model import coefficients, models
from lcpstep.recording import Kept
from lcpstep.trajectory import Status
from lcpstep.turns import turns


def start(
    scene: Scene, kind: Callable[..., Any], rtol: float, atol: float, *, yields: bool = False,
    modes: Functions | None = None, **more: Any,
) -> Any:  # fmt: skip
    """The state at the start of the span, of that kind of motion, which may ask for more than tolerances.

    yields : whether sliding that jams ends in an impact;  modes : fields of all modes, of a system that has some
    """
    contacts, joints, tangents = models(scene, modes)
    given: Any = scene.contacts
    friction = given and given.friction
    tangential = np.zeros(scene.n_c) if friction is None else friction.tangential(given.restitution)
    scan = scan_interval(scene, contacts, 0.0)
    corners = turns(scene, with_belts=True).stops
    n_t = 0 if friction is None else scene.n_c
    rows = Contacts(
        contacts, joints, scene.n_j, tangents, n_t, (rtol, atol), scene.t_span, corners, scene.period
    )
    s = kind(
        rows, coefficients(scene), tangential, friction is not None and friction.law == "stronge", yields,
        scan, **more,
    )  # fmt: skip
    s.state[: scene.n_q], s.state[scene.n_q :] = scene.q0, scene.v0
    s.next_step = FIRST_STEP * scan
    return s


class ContactRun(Integrated):
    """A run with contacts and joints; `fields`: those of all modes, of a system that has some."""

    fields: Functions | None = None

    def __init__(self, method: Any, scene: Scene, kept: Kept) -> None:
        s = self.system = self.start(scene, method)
        super().__init__(method, scene, kept, s.rows, s.scan_length, False)
        self.course = Course(s)

    def start(self, scene: Scene, method: Any) -> Any:
        """The motion at the start of the span."""
        yields = method.jamming == "impact"
        return start(scene, Smooth, method.rtol, method.atol, yields=yields, modes=self.fields)

    @property
    def evaluations(self) -> int:
        """How often forces were evaluated."""
        return int(self.system.evaluations)

    def message(self, code: int) -> str:
        """How the run ended, in words."""
        said, times = super().message(code), self.system.jams
        if times == 0:
            return said
        often = f"{times} time{'s' * (times > 1)}"
        return f"{said}; sliding jammed {often} and ended in impacts without collision (Kind.JAM)"

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == NO_SURFACE:
            return f"the obstacle of contact {self.system.rows.culprit} closes in, and leaves no room {self.where}"
        if code in (Status.PAINLEVE_INCONSISTENT, Status.PAINLEVE_INDETERMINATE):
            return f"{self.paradox(code)} {self.where}"
        if code == Status.NOT_FINITE and self.system.coefficients.fault():
            return f"{self.system.coefficients.fault()} {self.where}"
        return super().why(code)

    def paradox(self, code: int) -> str:
        """Painleve's paradox in words: the contact, and the coefficient of friction from which on it occurs."""
        c = int(self.system.rows.culprit)
        if c < 0:
            return f"no forces of the closed contacts {self.closed_ones} together, which rub, keep them from passing"
        mu, critical = self.system.coefficient(c), self.system.critical_friction(c)
        alone = critical > 0.0 and mu >= (1.0 - 1e-9) * critical
        limit = f" (critical at this state: {critical:.9g})" if alone else " beside what else is held"
        words = {
            Status.PAINLEVE_INCONSISTENT: "no force keeps it from passing the surface",
            Status.PAINLEVE_INDETERMINATE: "it may as well stay closed as open",
        }[Status(code)]
        return f"contact {c} slides with mu = {mu:g}{limit}, and {words}"
