"""simulate(scene, method): the one door to all methods."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Protocol, cast, overload
from weakref import WeakSet

import numpy as np

from lagrangian import HybridScene, Scene
from lagrangian.relations import check_derivatives, is_large
from lcpstep.callbacks.faults import fault, forget
from lcpstep.callbacks.hearing import hearing
from lcpstep.callbacks.prepared import prepared
from lcpstep.doubts.finished import doubt, warn_of_fast_gaps
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.recording import Keep, Kept
from lcpstep.refusals import refused
from lcpstep.trajectory import Status

if TYPE_CHECKING:
    from lcpstep.events.hybrid.trajectory import HybridTrajectory
    from lcpstep.trajectory import Trajectory

COMPARED: WeakSet[Scene] = WeakSet()  # scenes whose derivatives have been compared near states of a run


class Method(Protocol):
    """How a motion is computed: `lcpstep.Moreau`, `lcpstep.Located`, `lcpstep.EventDriven`."""

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene."""


def fitted(method: Method, t_span: tuple[float, float]) -> Method:
    """The method with no longer step than a span that is not of the user's choice."""
    h = getattr(method, "h", 0.0)
    fits = h <= t_span[1] - t_span[0]
    return method if fits else cast(Method, replace(cast(Any, method), h=t_span[1] - t_span[0]))


@overload
def simulate(
    scene: Scene,
    method: Method,
    *,
    keep: Keep = 1,
    progress: Callable[[float], None] | None = None,
    error: bool = False,
) -> Trajectory: ...
@overload
def simulate(
    scene: HybridScene,
    method: Method,
    *,
    keep: Keep = 1,
    progress: Callable[[float], None] | None = None,
    error: bool = False,
) -> HybridTrajectory: ...
@hearing
def simulate(
    scene: Scene | HybridScene,
    method: Method,
    *,
    keep: Keep = 1,
    progress: Callable[[float], None] | None = None,
    error: bool = False,
) -> Trajectory | HybridTrajectory:
    """Motion of a scene.

    Parameters
    ----------
    scene : lagrangian.Scene, or lagrangian.HybridScene for a system with modes (by `EventDriven`)
    method : lcpstep.Moreau, lcpstep.Located or lcpstep.EventDriven
    keep : which states the trajectory holds
        1: every step (default), and where events have their own times the states right after them; k: every k-th;
        increasing times: those; "impacts": those right after an event; but for times, start and end as well. The
        impact log is always complete.
    progress : called now and then with the time reached [s]
    error : whether the trajectory gets an error bar, `Trajectory.error` (`lcpstep.errorbar.bars.ErrorBar`), from a
        second run by another method, which takes about the time of the run again

    Returns
    -------
    Trajectory, or HybridTrajectory of a system with modes; its `status` is DONE, or says why the run ended before the
        end of the span; `doubt` says where a run lies as deep inside an obstacle as its motion is large, where an
        obstacle leaves no room to it, leaps, or its gap has no gradient where it is met, or is positive on both
        sides of it, where the velocity of a frame jumps, where steps are too long for the forces that it meets,
        lose energy, turn by more than a radian what holds the motion, see no period of its oscillations or of its
        hops, or make it faster than forces and obstacles could, or where contacts slide that share a normal, with
        friction in two directions

    Raises
    ------
    TypeError   scene is no Scene, method no method, progress no function, or error neither True nor False
    ValueError   keep is none of the above
    LcpStepError   the method does not treat the scene, its step is longer than the span, or it has no error bar
    SimulationError   a callback or the motion became infinite or not-a-number; carries the motion so far
    SimulationInterrupted   a KeyboardInterrupt; carries the motion so far

    Examples
    --------
    >>> from lagrangian import scenes
    >>> from lcpstep import Moreau, simulate
    >>> ball = simulate(scenes.bouncing_ball(t_end=1.0), Moreau(h=1e-3))
    >>> ball.status.name
    'DONE'
    """
    _check(scene, method, progress, error)
    kept, report = Kept.parse(keep, scene.t_span), progress or (lambda _: None)
    if isinstance(scene, HybridScene):
        return _run_modes(scene, method, kept, report)
    if is_large(scene):
        _compare_first(scene)
    if error:
        return _run_with_error(scene, method, kept, report)
    return _looked_over(_unbroken(_run(scene, method, kept, report)))


def _check(scene: Any, method: Any, progress: Any, error: Any) -> None:
    """TypeError or LcpStepError where an argument is none of those asked for, or there is no error bar."""
    if not isinstance(scene, (Scene, HybridScene)):
        raise TypeError(f"scene: expected a lagrangian.Scene, got {scene!r}")
    if isinstance(method, type) or not hasattr(method, "run"):
        raise TypeError(f"method: expected for example lcpstep.Moreau(h=1e-4), got {method!r}")
    if progress is not None and not callable(progress):
        raise TypeError(f"progress: expected a function of the time reached, got {progress!r}")
    if not isinstance(error, bool):
        raise TypeError(f"error: expected True or False, got {error!r}")
    if error:
        _can_tell_errors(scene, method)


def _run_modes(
    scene: HybridScene, method: Any, kept: Kept, report: Callable[[float], None]
) -> HybridTrajectory:
    """The motion of a system with modes; SimulationError where a callback has raised."""
    if not hasattr(method, "run_hybrid"):
        raise refused("modes-method", scene)
    if getattr(method, "audit", False):
        raise refused("modes-audit", scene)
    run: HybridTrajectory = method.run_hybrid(scene, kept, report)
    if fault() is not None:
        from lcpstep.callbacks.culprits import hybrid_culprit

        raise _raised(run, hybrid_culprit(scene, run.mode[-1]))
    return run


def _run(scene: Scene, method: Method, kept: Kept, report: Callable[[float], None]) -> Trajectory:
    """The motion by the method, which an audit calls where one was asked for."""
    if getattr(method, "audit", False):
        from lcpstep.audit import audited

        return audited(method, scene, kept, report)
    return method.run(scene, kept, report)


def _unbroken(run: Trajectory) -> Trajectory:
    """The run; SimulationError where a callback has raised in it."""
    if fault() is not None:
        from lcpstep.callbacks.culprits import culprit

        raise _raised(run, culprit(run.scene, (), run.q, run.v))
    return run


def _run_with_error(scene: Scene, method: Method, kept: Kept, report: Callable[[float], None]) -> Trajectory:
    """The motion with its error bar, told by states between those kept; an interrupt leaves it without one."""
    from lcpstep.errorbar.estimate import error_bar
    from lcpstep.errorbar.wide import narrowed, widened

    begin, more = time.process_time(), widened(method, scene, kept)
    wide = _run(scene, method, more, report)
    seconds = time.process_time() - begin
    run = _looked_over(_unbroken(wide if more is kept else narrowed(wide, more)))
    times = more.times if run is not wide else None
    try:
        return replace(run, error=error_bar(run if times is None else wide, more.all, seconds, times))
    except KeyboardInterrupt:
        raise SimulationInterrupted(lambda: run) from None


def _looked_over(run: Trajectory) -> Trajectory:
    """The run with its doubt, if there is one; an interrupt leaves it as it is, and its message says so."""
    try:
        _compare_derivatives(run)
        warn_of_fast_gaps(run)
        words = doubt(run)
    except KeyboardInterrupt:
        unseen = replace(run, message=f"{run.message}; interrupted before its states were looked over")
        raise SimulationInterrupted(lambda: unseen) from None
    return replace(run, doubt=words, message=f"{run.message}, but {words}") if words else run


def _can_tell_errors(scene: Any, method: Method) -> None:
    """LcpStepError where there is no error bar."""
    from lcpstep.errorbar.companions import KNOWN
    from lcpstep.model import LARGEST_DENSE
    from lcpstep.stepping.moreau import is_sparse

    if isinstance(scene, HybridScene):
        raise refused("modes-error", scene)
    if is_sparse(scene) and scene.n_q > LARGEST_DENSE:
        raise refused("dense", scene, argument="error")
    if not isinstance(method, KNOWN):
        names = ", ".join(x.__name__ for x in KNOWN)
        raise LcpStepError(f"error: expected one of the methods {names}, got {method!r}")


def _compare_first(scene: Scene) -> None:
    """ValueError where a derivative is wrong at the start, of a scene too large to be looked at when it was made."""
    check_derivatives(scene, [(scene.t_span[0], np.array(scene.q0), np.array(scene.v0))], False, prepared)
    forget()


def _compare_derivatives(run: Trajectory) -> None:
    """SimulationError where a derivative of the scene is wrong at states that the start has not shown.

    Once for a scene: its functions and parameters stay what they are.
    """
    if run.scene in COMPARED:
        return

    def states() -> Iterator[tuple[float, Any, Any]]:
        last = len(run.t) - 1
        for k in sorted({min(1, last), (last + 1) // 2, last}) if last >= 0 else ():
            yield float(run.t[k]), run.q[k], run.v[k]

    try:
        check_derivatives(run.scene, states(), True, prepared)
    except ValueError as error:
        raise SimulationError(str(error), run) from error
    finally:
        forget()  # callbacks may fail at states that the motion has not reached
    COMPARED.add(run.scene)


def _raised(run: Any, message: str) -> SimulationError:
    """The error of a run in which a callback has raised an exception that no step has come to feel."""
    return SimulationError(message, replace(run, status=Status.NOT_FINITE, message=message))
