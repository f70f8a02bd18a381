"""One check: a scene, what is measured on it, and the bound that each method has to meet.

A check is a function that gets a `Solver` and returns how far off the method is; `@check` registers it:

    @check("elastic-ball", "energy", period=0.9, event_driven=1e-13)
    def ball(solve):
        return gained(solve(elastic_ball()))

and `states` one on a motion in closed form:

    states("bouncing-ball", "states", bouncing_ball, period=0.9, event_driven=1e-13, moreau=FIRST_ORDER)

The bounds are those of excellent code with default settings, never fitted to what a method gives. `FIRST_ORDER`
stands for what plain Moreau time-stepping promises: an impact moved by a step displaces the motion by no more than

    h (sum of |u+ - u-| over all impacts + largest speed),  and no more than 5 % of the size of the motion;

and `SECOND_ORDER` for what a step of order two promises, the phase that the trapezoidal rule loses in T/period
periods:

    size (2 pi h/period)^2 T/period,  and no more than 5 % of the size of the motion.
"""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.errorbar.estimate import error_bar
from lcpstep.errors import LcpStepError, SimulationError
from lcpstep.hard.methods import METHODS, MOREAU
from lcpstep.recording import Keep
from lcpstep.simulation import simulate
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
SAMPLES = 997  # times at which a motion is compared; a prime, to meet no grid of steps
STEPS = 100  # per typical period
MOREAU_STEPS = 1000  # the same for plain Moreau, which is of order one
WORTHLESS = 0.05  # a motion that is off by this part of its size is another motion
FIRST_ORDER, SECOND_ORDER = -1.0, -2.0  # in the place of a bound


class Stopped(Exception):
    """A run that ended before its time."""


@dataclass(frozen=True)
class Found:
    """What a check measured: how far off, and a remark."""

    error: float
    note: str = ""


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    scene, what, method : which check, by which method
    outcome : "passed", "failed", or "refused": the method says that it does not treat this scene
    error, bound : how far off, and how far it may be; None where there is none
    seconds : time of the runs, compilation left out
    note : why it failed or was refused, or a remark
    bar : what error bars of its runs say, the largest: positions [m] or, if that is more, the mean of velocities
        [m/s], of plain Moreau positions alone; None where none was asked for
    known : share of the span up to which they hold
    """

    scene: str
    what: str
    method: str
    outcome: str
    error: float | None
    bound: float | None
    seconds: float
    note: str = ""
    bar: float | None = None
    known: float = 1.0

    @property
    def passed(self) -> bool:
        """Whether the method met the bound."""
        return self.outcome == "passed"

    def as_json(self) -> dict[str, Any]:
        """The line as JSON carries it: finite numbers or null."""
        finite = {
            name: x if x is not None and np.isfinite(x) else None
            for name, x in (("error", self.error), ("bound", self.bound), ("bar", self.bar))
        }
        return {
            "scene": self.scene, "what": self.what, "method": self.method, "passed": self.passed,
            "outcome": self.outcome, **finite, "bar_holds_for": self.known, "seconds": self.seconds,
            "note": self.note,
        }  # fmt: skip


class Solver:
    """Runs scenes by one method with the step of the check, and keeps account of the work.

    bars : whether runs get error bars; `seconds` is the time without them, `bar` the largest, `known` the share
        of the span that all of them cover
    """

    def __init__(self, method: str, period: float, bars: bool = False) -> None:
        self.method, self.bars = method, bars
        self.bar: float | None = None
        self.known = 1.0
        self.h, self.period = period / (MOREAU_STEPS if method == MOREAU else STEPS), period
        self.seconds = self.jumps = self.speed = self.size = self.length = 0.0

    def __call__(self, scene: Scene, keep: Keep = 1, h: float | None = None) -> Trajectory:
        """The motion of a scene; `Stopped` where the run ends early."""
        method = METHODS[self.method](self.h if h is None else h)
        t_start, t_end = scene.t_span
        warm = replace(scene, t_span=(t_start, t_start + 1e-9 * (t_end - t_start)))
        simulate(warm, METHODS[self.method](1e-9 * (t_end - t_start)))  # takes the compilation
        begin = time.perf_counter()
        run = simulate(scene, method, keep=keep)
        seconds = time.perf_counter() - begin
        self.seconds += seconds
        if run.status != Status.DONE:
            raise Stopped(f"{run.status.name}: {run.message}")
        if self.bars:
            self._tell(simulate(scene, method), seconds)
        log = run.impacts[run.impacts.kind == Kind.IMPACT]
        self.jumps = max(self.jumps, float(np.sum(np.abs(log.after - log.before))))
        self.speed = max(self.speed, float(np.max(np.abs(run.v), initial=0.0)))
        self.length = max(self.length, t_end - t_start)
        self.size = max(self.size, float(np.max(np.ptp(run.q, axis=0), initial=0.0)))
        return run

    def _tell(self, run: Trajectory, seconds: float) -> None:
        """Note what the error bar of a run that kept every step says, as `state_error` measures it."""
        bar, (start, end) = error_bar(run, True, seconds), run.scene.t_span
        speed = 0.0 if self.method == MOREAU else bar.velocity.l1 / (bar.until - start or 1.0)
        self.bar = max(bar.position.sup, speed, self.bar or 0.0)
        self.known = min((bar.until - start) / (end - start), self.known)

    def first_order(self) -> float:
        """What order one allows: see the head of this file."""
        return min(self.h * (self.jumps + self.speed), WORTHLESS * self.size)

    def second_order(self) -> float:
        """What order two allows: see the head of this file."""
        lost = (2.0 * np.pi * self.h / self.period) ** 2 * self.length / self.period
        return min(lost, WORTHLESS) * self.size


@dataclass(frozen=True)
class Check:
    """A scene, what is measured on it, and the bound of every method that fits."""

    scene: str
    what: str
    measure: Callable[[Solver], Found | float]
    period: float
    bounds: Mapping[str, float]
    heavy: bool = False


CHECKS: list[Check] = []


def check(
    scene: str, what: str, *, period: float = 1.0, heavy: bool = False, **bounds: float
) -> Callable[[Callable[[Solver], Found | float]], Callable[[Solver], Found | float]]:
    """Register a check; the methods are given by name, event_driven for "event-driven"."""

    def registered(measure: Callable[[Solver], Found | float]) -> Callable[[Solver], Found | float]:
        named = {name.replace("_", "-"): bound for name, bound in bounds.items()}
        CHECKS.append(Check(scene, what, measure, period, named, heavy))
        return measure

    return registered


def run_check(c: Check, method: str, bars: bool = False) -> Row:
    """Put one method to a check; with `bars` its runs get error bars."""
    solve, bound = Solver(method, c.period, bars), c.bounds[method]
    shown = None if bound < 0.0 else bound
    try:
        found = c.measure(solve)
    except Stopped as stopped:
        return Row(c.scene, c.what, method, "failed", None, shown, solve.seconds, str(stopped))
    except SimulationError as error:
        return Row(c.scene, c.what, method, "failed", None, shown, solve.seconds, str(error))
    except LcpStepError as refusal:
        return Row(c.scene, c.what, method, "refused", None, shown, solve.seconds, str(refusal))
    except Exception as error:  # a method that breaks fails this check, and not the rest of the table
        note = f"{type(error).__name__}: {error}"
        return Row(c.scene, c.what, method, "failed", None, shown, solve.seconds, note)
    found = found if isinstance(found, Found) else Found(float(found))
    if bound < 0.0:
        bound = solve.first_order() if bound == FIRST_ORDER else solve.second_order()
    outcome = "passed" if found.error <= bound else "failed"
    return Row(
        c.scene,
        c.what,
        method,
        outcome,
        found.error,
        bound,
        solve.seconds,
        found.note,
        solve.bar,
        solve.known,
    )


def sample_times(scene: Scene) -> Array:
    """Times at which a motion is compared, spread over the span."""
    t_start, t_end = scene.t_span
    return t_start + (t_end - t_start) * (np.arange(SAMPLES) + 0.5) / SAMPLES


def state_error(solve: Solver, scene: Scene) -> float:
    """Largest |q - q_exact| [m] or, if that is more, the mean of |v - v_exact| [m/s].

    The mean, for a velocity that jumps is wrong by the whole jump in between two times that are a rounding apart. Of
    plain Moreau, which promises no times of impacts, the positions alone.
    """
    if scene.exact is None:
        raise ValueError(f"scene: {scene.name!r} has no motion in closed form")
    times = sample_times(scene)
    run = solve(scene, keep=times)
    q, v = scene.exact(times)
    error = float(np.max(np.abs(run.q - q)))
    return error if solve.method == MOREAU else max(error, float(np.max(np.mean(np.abs(run.v - v), axis=0))))


def states(
    scene: str,
    what: str,
    make: Callable[[], Scene],
    *,
    period: float = 1.0,
    heavy: bool = False,
    **bounds: float,
) -> None:
    """Register a check on the motion of a scene that has one in closed form, worked out once: its `state_error`."""
    made = functools.cache(make)

    @check(scene, what, period=period, heavy=heavy, **bounds)
    def measure(solve: Solver) -> float:
        return state_error(solve, made())
