"""What is simulated, for how long, and the answer to compare with.

    bouncing-ball       5 s: 4.06 s of flight with infinitely many impacts, then rest; closed form
    impact-oscillator   20 s, 7 impacts; an error at the start is not amplified. And 400 s for the cost of an impact
    cam-follower        358 rpm from q = 0.4 m, q' = 0.4 m/s, 1 s, 15 impacts; an error at the start grows twelvefold

The last two are compared with `EventDriven` at tolerances of 1e-13, and that one with `tests.exact`, a computation
to fifty digits that shares nothing with the library.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.stepping import user_scene
from lagrangian import Scene, scenes
from lcpstep import EventDriven, Kind, Trajectory, simulate

Array = NDArray[np.float64]
REFERENCE = EventDriven(rtol=1e-13, atol=1e-13)
INSTANTS = 400  # at which the reference itself is judged
RPM = 358.0


@dataclass(frozen=True)
class Question:
    """A scene for a time, and what is known about its motion."""

    name: str
    make: Callable[..., Scene]
    t_end: float

    def scene(self, t_end: float | None = None) -> Scene:
        """The scene, for another time if asked."""
        return self.make(t_end=self.t_end if t_end is None else t_end)

    def position(self, t: Array) -> Array:
        """The right answer at the times t."""
        if self.name == "bouncing-ball":
            return ball_height(t)
        return self.reference().at(t)[0][:, 0]

    def first_impact(self) -> float:
        """Time of the first impact [s]."""
        if self.name == "bouncing-ball":
            return math.sqrt(2.0 / 9.81)
        return float(impact_times(self.reference())[0])

    @cache  # noqa: B019  (five questions, alive as long as the program)
    def reference(self) -> Trajectory:
        """The event-driven motion at the tightest tolerances."""
        return simulate(self.scene(), REFERENCE)

    def errors(self, t: Array, q: Array, first: float) -> dict[str, float]:
        """Sup norm of the position error, and the error of the first impact time."""
        return {
            "sup_q": float(np.max(np.abs(q - self.position(t)))),
            "first_impact": abs(first - self.first_impact()),
        }


BALL = Question("bouncing-ball", scenes.bouncing_ball, 5.0)
OSCILLATOR = Question("impact-oscillator", scenes.impact_oscillator, 20.0)
LONG = Question("impact-oscillator", scenes.impact_oscillator, 400.0)
CAM = Question("cam-follower", scenes.cam_follower, 1.0)
USER_LINEAR = Question("user-linear", user_scene.linear, 10.0)
USER_NONLINEAR = Question("user-nonlinear", user_scene.nonlinear, 10.0)
READY = (BALL, OSCILLATOR, CAM)


def impact_times(motion: Trajectory) -> Array:
    log = motion.impacts
    return np.asarray(log.time[log.kind == Kind.IMPACT], dtype=float)


def errors_of(question: Question, motion: Trajectory) -> dict[str, float]:
    """Errors of a run of the library that kept every step."""
    return question.errors(motion.t, motion.q[:, 0], float(impact_times(motion)[0]))


def errors_of_events(question: Question, motion: Trajectory) -> dict[str, float]:
    """Errors of an event-driven run, on its dense output, against an answer that is not the library's own."""
    if question.name == "bouncing-ball":
        t = np.linspace(0.0, question.t_end, 20 * INSTANTS)
        q = ball_height(t)
    else:
        t, q = exact_positions(question.name, question.t_end)
    first = abs(float(impact_times(motion)[0]) - exact_first_impact(question.name, question.t_end))
    return {"sup_q": float(np.max(np.abs(motion.at(t)[0][:, 0] - q))), "first_impact": first}


def sensitivity(question: Question, disturbance: float = 1e-9) -> float:
    """How much an error of the initial position has grown, at most, by the end."""
    scene = question.scene()
    moved = replace(scene, q0=np.asarray(scene.q0) + disturbance)
    t = np.linspace(0.0, question.t_end, 100_001)
    apart = simulate(moved, REFERENCE).at(t)[0] - question.reference().at(t)[0]
    return float(np.max(np.abs(apart))) / disturbance


def ball_height(t: Array, h0: float = 1.0, g: float = 9.81, r: float = 0.8) -> Array:
    """Closed form of the ball that falls from rest."""
    flights = 2.0 * math.sqrt(2.0 * h0 / g) * r ** np.arange(1, 200)
    impacts = math.sqrt(2.0 * h0 / g) + np.concatenate([[0.0], np.cumsum(flights)])
    k = np.searchsorted(impacts, t, side="right") - 1
    speed = math.sqrt(2.0 * h0 * g) * r ** (k + 1.0)
    since = t - impacts[np.maximum(k, 0)]
    hop = np.where(k < len(impacts) - 1, speed * since - 0.5 * g * since**2, 0.0)
    return np.where(k < 0, h0 - 0.5 * g * t**2, np.maximum(hop, 0.0))


@cache
def exact_positions(name: str, t_end: float) -> tuple[Array, Array]:
    """Times, and positions there to fifty digits."""
    from tests.exact import mpf

    motion, lift = _exact_motion(name, t_end)
    t = np.linspace(0.0, t_end, INSTANTS)
    return t, np.array([float(motion.at(x)[0] - lift(mpf(x))) for x in t])


@cache
def exact_first_impact(name: str, t_end: float) -> float:
    if name == "bouncing-ball":
        return BALL.first_impact()
    return float(_exact_motion(name, t_end)[0].events[0][1])


@cache
def _exact_motion(name: str, t_end: float) -> tuple[Any, Callable[[Any], Any]]:
    from tests import exact

    if name == "impact-oscillator":
        body = exact.Body(c=exact.mpf("0.05") * 2, k=1, fc=1, Omega=2, r=exact.mpf(0.8), side=-1)
        return exact.motion(body, -0.5, 0.0, t_end), lambda t: 0
    body = exact.Body(m=1.221, k=1430.8, r=0.8, s=exact.cam(RPM), corners=exact.cam_corners(RPM), scan=0.002)
    lift, speed, _ = body.s(exact.mpf(0), exact.mpf(10) ** -9)
    motion = exact.motion(body, lift + exact.mpf(0.4), speed + exact.mpf(0.4), t_end)
    return motion, lambda t: body.s(t, t)[0]
