"""What the errors of a study are measured against, and how well that is known itself.

In this order: what the caller gives, the scene's motion in closed form, the event-driven run at its tightest.
A run is checked by one of an independent method, and their distance says how well it is known: an event-driven run
by `Located` in exact pieces, or of order 4 in fine steps, anything else by the event-driven method. Where no other
method treats the scene, the same one at a looser tolerance is left, which sees no error that does not depend on it.
A closed form is checked against an event-driven run wherever that fits the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.accuracy.dials import dial, shown, with_value
from lcpstep.accuracy.errors import Difference, Motion
from lcpstep.described import checksum
from lcpstep.errorbar.companions import best
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.simulation import Method, simulate
from lcpstep.stepping.located import Located, require_exact
from lcpstep.trajectory import IMPACT_DTYPE, Status, Trajectory

Array = NDArray[np.float64]
TIGHTEST = EventDriven(rtol=1e-13, atol=1e-13)
LOOSER, COARSER = 100.0, 2.0
PIECES, MOST = 100, 200_000  # steps of order 4 in one of the event-driven method, and in the span at most
GRID = 2000
AGREES = 1e-8  # of the size of the motion: a closed form and an event-driven run further apart contradict each other


@dataclass(frozen=True, eq=False)
class KnownMotion:
    """A motion given as a function of time.

    Parameters
    ----------
    scene : the scene it is a motion of
    state : t -> (q, v); numbers or (n_q,) for a number t, or (m, n_q) for times (m,)
    impacts : its impact log; without one, jumps of the velocity are only seen on a grid

    Raises
    ------
    ValueError   the function fails, or does not start in the scene's initial state
    """

    scene: Scene
    state: Callable[[Any], Any]
    impacts: Any = field(default_factory=lambda: np.zeros(0, dtype=IMPACT_DTYPE).view(np.recarray))

    def __post_init__(self) -> None:
        scene = self.scene
        try:
            q, _ = self.at(scene.t_span[0])
        except Exception as error:
            raise ValueError(f"reference: expected a function t -> (q, v); it failed: {error}") from error
        scale = 1.0 + float(np.max(np.abs(scene.q0)))
        if not np.allclose(q, scene.q0, rtol=0.0, atol=1e-9 * scale):
            raise ValueError(
                f"reference: expected to start at q0 = {np.asarray(scene.q0).tolist()} of the scene, got {q.tolist()}"
            )

    @property
    def t(self) -> Array:
        """A grid over the scene's span."""
        return np.linspace(*self.scene.t_span, GRID + 1)

    def at(self, t: Any) -> tuple[Array, Array]:
        """States at any times."""
        times, n_q = np.atleast_1d(np.asarray(t, dtype=float)), self.scene.n_q
        try:
            q, v = (np.asarray(x, dtype=float).reshape(len(times), n_q) for x in self.state(times))
        except (TypeError, ValueError):  # a function of one number
            pairs = [self.state(float(x)) for x in times]
            q, v = (np.array([p[k] for p in pairs], dtype=float).reshape(len(times), n_q) for k in (0, 1))
        return (q[0], v[0]) if np.ndim(t) == 0 else (q, v)


@dataclass(frozen=True, eq=False)
class Reference:
    """A motion to measure against.

    Attributes
    ----------
    motion : the motion, or None where there is none
    text : what it is, in words
    check : the motion that it was checked by, or None
    method : the method it comes from, or was checked by; None where there is neither
    notes : what the reader of the errors must know
    """

    motion: Motion | None
    text: str
    check: Motion | None = None
    method: Method | None = None
    notes: tuple[str, ...] = ()

    def uncertainty(self, measures: Sequence[str], until: float | None = None) -> dict[str, float]:
        """How far it may be off up to a time, by measure: its distance to the check; empty where not known."""
        if self.motion is None or self.check is None:
            return {}
        apart = Difference(self.motion, self.check, t_end=until)
        return {m: float(getattr(apart, m)) for m in measures}

    @property
    def knows_impacts(self) -> bool:
        """Whether it has an impact log."""
        return not (isinstance(self.motion, KnownMotion) and self.method is None)


def find_reference(scene: Scene, given: Any) -> Reference:
    """The reference of a study.

    Parameters
    ----------
    given : None, a method, a `Trajectory`, or a function t -> (q, v)

    Raises
    ------
    TypeError   given is none of these
    ValueError   a trajectory of another scene, or a function that does not fit
    """
    if given is None:
        if scene.exact is not None:
            return from_formula(scene, scene.exact)
        return _tightest(scene)
    if hasattr(given, "run") and not isinstance(given, type):
        return from_method(scene, given)
    if hasattr(given, "at") and hasattr(given, "t"):
        return from_trajectory(scene, given)
    if callable(given) and not isinstance(given, type):
        return from_formula(scene, given)
    raise TypeError(f"reference: expected a method, a trajectory or a function t -> (q, v), got {given!r}")


def _tightest(scene: Scene) -> Reference:
    """By the event-driven method, at tolerances that are small beside the motion."""
    found = from_method(scene, TIGHTEST)
    if isinstance(found.motion, Trajectory) and best(found.motion).atol < TIGHTEST.atol:
        return from_method(scene, best(found.motion))
    return found


def from_method(scene: Scene, method: Method) -> Reference:
    """A run, checked by one of another method."""
    motion, failure = _done(scene, method)
    if motion is None:
        note = f"no reference: {failure}. Errors are left out; give reference= a method, a trajectory or a function"
        return Reference(None, "none", notes=(note,))
    for other in independent(motion):
        check, _ = _done(scene, other)
        if check is not None:
            return Reference(motion, f"{shown(method)}; checked by {shown(other)}", check, method)
    return _checked_by_itself(scene, motion)


def independent(motion: Trajectory) -> Iterator[Method]:
    """Methods that share nothing with that of a run, the best for its scene first."""
    if not isinstance(motion.method, EventDriven):
        yield TIGHTEST
        return
    span, steps = float(motion.t[-1] - motion.t[0]), max(motion.counts.steps, 1)
    try:
        require_exact(motion.scene)
        yield Located(span / steps, "exact")
    except LcpStepError:
        pass  # order 4 takes what is not linear
    h = max(span / (PIECES * steps), span / MOST)
    yield Located(h, 4)
    yield Located(h)  # with joints


def _checked_by_itself(scene: Scene, motion: Trajectory) -> Reference:
    """A run that no other method checks, by the same one looser."""
    method = motion.method
    name, value = dial(method)
    if not name:
        note = "how good the reference is cannot be told: its method has neither a step nor a tolerance to change"
        return Reference(motion, shown(method), method=method, notes=(note,))
    looser = with_value(method, value * (COARSER if name == "h" else LOOSER))
    check, failure = _done(scene, looser)
    if check is None:
        note = f"how good the reference is cannot be told: {looser!r} fails: {failure}"
        return Reference(motion, shown(method), method=method, notes=(note,))
    note = f"the reference is checked by itself alone, at another {name}: no other method treats the scene"
    return Reference(motion, f"{shown(method)}; checked by {shown(looser)}", check, method, (note,))


def _done(scene: Scene, method: Method) -> tuple[Trajectory | None, str]:
    """A run that reaches the end of the span, or None and why it does not."""
    try:
        motion = simulate(scene, method)
    except (LcpStepError, ValueError) as error:
        return None, str(error)
    if motion.status is not Status.DONE:
        return None, f"the run of {method!r} ended early, {motion.message}"
    return motion, ""


def from_trajectory(scene: Scene, motion: Trajectory) -> Reference:
    """A run of the caller's."""
    own = motion.scene
    begins = own.n_q == scene.n_q and np.isclose(motion.t[0], scene.t_span[0], rtol=1e-12, atol=0.0)
    if not (begins and all(np.allclose(*x, rtol=1e-12) for x in ((own.q0, scene.q0), (own.v0, scene.v0)))):
        raise ValueError(
            "reference: the trajectory is not one of this scene; its initial state or time differs"
        )
    notes = ["how good the reference is cannot be told: it was given as a trajectory"]
    if not alike(own, scene):
        notes.append(
            "the trajectory given is of another scene: system, contacts, joints or parameters differ"
        )
    if motion.t[-1] < scene.t_span[1]:
        notes.append(f"the reference ends at t = {motion.t[-1]:g} s, and with it the comparison")
    method = motion.method if isinstance(motion, Trajectory) else None
    return Reference(motion, f"the trajectory given, {method!r}", method=method, notes=tuple(notes))


def alike(one: Scene, other: Scene) -> bool:
    """Whether states move on alike in two scenes."""
    return one is other or checksum(one) == checksum(other)


def from_formula(scene: Scene, state: Callable[[Any], Any]) -> Reference:
    """A motion in closed form; its impact log is that of an event-driven run, where the two agree."""
    known = KnownMotion(scene, state)
    check, _ = _done(scene, TIGHTEST)
    if check is None:
        note = "no event-driven run fits the scene: impacts of the closed form are not known, and it is not checked"
        return Reference(known, "closed form", notes=(note,))
    size = float(np.max(np.ptp(known.at(known.t)[0], axis=0)))
    apart = Difference(known, check).sup_position
    if not apart <= AGREES * size:
        note = (
            f"the closed form and the event-driven run differ by {apart:.2g}: one of them is wrong; see both"
        )
        return Reference(known, "closed form", check, notes=(note,))
    known = KnownMotion(scene, state, check.impacts)
    text = f"closed form; the event-driven run agrees with it to {apart:.1e}"
    return Reference(known, text, check, TIGHTEST)
