"""What the errors of a study are measured against, and how well that is known itself.

In this order: what the caller gives, the scene's motion in closed form, the event-driven run at its tightest.
A method is run twice, the second time a hundred times looser (or at twice the step): the distance of the two
bounds its error. A closed form is checked against an event-driven run wherever that fits the scene.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene
from lcpstep.analysis.dials import dial, shown, with_value
from lcpstep.analysis.errors import Difference, Motion
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.simulation import Method, simulate
from lcpstep.trajectory import IMPACT_DTYPE, Status, Trajectory

Array = NDArray[np.float64]
TIGHTEST = EventDriven(rtol=1e-13, atol=1e-13)
LOOSER, COARSER = 100.0, 2.0
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
    uncertainty : how far it may be off, by measure; a measure that is missing is not known
    method : the method it comes from, or was checked by; None where there is neither
    notes : what the reader of the errors must know
    """

    motion: Motion | None
    text: str
    uncertainty: dict[str, float] = field(default_factory=dict)
    method: Method | None = None
    notes: tuple[str, ...] = ()

    @property
    def knows_impacts(self) -> bool:
        """Whether it has an impact log."""
        return not (isinstance(self.motion, KnownMotion) and self.method is None)


def find_reference(scene: Scene, given: Any, measures: Sequence[str]) -> Reference:
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
            return from_formula(scene, scene.exact, measures)
        return from_method(scene, TIGHTEST, measures)
    if hasattr(given, "run") and not isinstance(given, type):
        return from_method(scene, given, measures)
    if hasattr(given, "at") and hasattr(given, "t"):
        return from_trajectory(scene, given)
    if callable(given) and not isinstance(given, type):
        return from_formula(scene, given, measures)
    raise TypeError(f"reference: expected a method, a trajectory or a function t -> (q, v), got {given!r}")


def from_method(scene: Scene, method: Method, measures: Sequence[str]) -> Reference:
    """A run, checked by a second one."""
    try:
        motion = simulate(scene, method)
    except (LcpStepError, ValueError) as error:
        note = f"no reference: {error}. Errors are left out; give reference= a method, a trajectory or a function"
        return Reference(None, "none", notes=(note,))
    if motion.status is not Status.DONE:
        note = f"no reference: the run of {method!r} ended early, {motion.message}. Errors are left out"
        return Reference(None, "none", notes=(note,))
    name, value = dial(method)
    if not name:
        note = "how good the reference is cannot be told: its method has neither a step nor a tolerance to change"
        return Reference(motion, shown(method), method=method, notes=(note,))
    looser = with_value(method, value * (COARSER if name == "h" else LOOSER))
    try:
        check = simulate(scene, looser)
    except (LcpStepError, ValueError) as error:
        note = f"how good the reference is cannot be told: {looser!r} fails: {error}"
        return Reference(motion, shown(method), method=method, notes=(note,))
    apart = Difference(motion, check)
    return Reference(
        motion,
        f"{shown(method)}; checked by {shown(looser)}",
        {m: float(getattr(apart, m)) for m in measures},
        method,
    )


def from_trajectory(scene: Scene, motion: Trajectory) -> Reference:
    """A run of the caller's."""
    if motion.scene.n_q != scene.n_q or not np.allclose(motion.at(motion.t[0])[0], scene.q0, rtol=1e-12):
        raise ValueError("reference: the trajectory is not one of this scene; its initial state differs")
    notes = ["how good the reference is cannot be told: it was given as a trajectory"]
    if motion.t[-1] < scene.t_span[1]:
        notes.append(f"the reference ends at t = {motion.t[-1]:g} s, and with it the comparison")
    method = motion.method if isinstance(motion, Trajectory) else None
    return Reference(motion, f"the trajectory given, {method!r}", method=method, notes=tuple(notes))


def from_formula(scene: Scene, state: Callable[[Any], Any], measures: Sequence[str]) -> Reference:
    """A motion in closed form; its impact log is that of an event-driven run, where the two agree."""
    known = KnownMotion(scene, state)
    check = from_method(scene, TIGHTEST, ())
    if check.motion is None:
        note = "no event-driven run fits the scene: impacts of the closed form are not known, and it is not checked"
        return Reference(known, "closed form", notes=(note,))
    size = float(np.max(np.ptp(known.at(known.t)[0], axis=0)))
    apart = Difference(known, check.motion).sup_position
    if not apart <= AGREES * size:
        note = (
            f"the closed form and the event-driven run differ by {apart:.2g}: one of them is wrong; see both"
        )
        return Reference(known, "closed form", notes=(note,))
    known = KnownMotion(scene, state, check.motion.impacts)
    text = f"closed form; the event-driven run agrees with it to {apart:.1e}"
    agreement = Difference(known, check.motion)
    return Reference(known, text, {m: float(getattr(agreement, m)) for m in measures}, check.method)
