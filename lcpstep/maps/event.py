"""The map from one event of a contact to the next: of a scene with contacts, friction and joints, driven or not.

A point is the state right after the event; where the scene has a period, the phase of the forcing in [0, 2 pi) and
the state. Coordinates that the equations do not know of, as the height of a toy that climbs down its pole, are left
out (`cyclic`). With J the derivative of the motion up to just before the event, at a fixed time, and H its guard,

    DP = (R_x - (R_x F- + R_t) H_x / (H_x F- + H_t)) J

in the terms of `saltation.rubbing`. Sources as there.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError, UnknownName
from lcpstep.events import EventDriven
from lcpstep.maps.phase import NoReturn, bounded, is_driven, limit_of, phase_of, time_of, waits, with_phase
from lcpstep.maps.saltation.rubbing import Walk
from lcpstep.simulation import simulate
from lcpstep.trajectory import Kind, Status, Trajectory

Array = NDArray[np.float64]
AT_ONCE = 1e-9  # of the span: an event this soon after the start is that of the start
KINDS = ("IMPACT", "SLIP", "STICK_TANGENT", "REVERSE", "STICK", "RELEASE")


class Return(NamedTuple):
    """Where a motion comes back: whole state, time of the event, and the run up to it."""

    state: Array
    time: float
    start: float
    run: Trajectory


@dataclass(frozen=True, eq=False)
class EventMap:
    """x -> the point at which the same contact has the same kind of event next.

    Parameters
    ----------
    scene : lagrangian.Scene with contacts; its initial state is where `entry` sets out
    method : lcpstep.EventDriven
    kind : "IMPACT", "SLIP", "STICK_TANGENT", "REVERSE", "STICK" or "RELEASE", see `lcpstep.trajectory.Kind`
    contact : number of the contact
    cyclic : numbers of the coordinates that are left out of points; they begin at the scene's own
    limit : time to wait for the next event; twenty lengths of the scene's span where not given

    Raises
    ------
    UnknownName   no such kind of events
    ValueError   the scene has no such contact or coordinate, or limit is not positive
    """

    scene: Scene
    method: EventDriven
    kind: str
    contact: int = 0
    cyclic: tuple[int, ...] = ()
    limit: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.scene, Scene):
            raise ValueError("scene: expected a lagrangian.Scene; for one with modes see SwitchMap")
        if self.kind not in KINDS:
            raise UnknownName("kind of events", self.kind, KINDS)
        if not 0 <= self.contact < self.scene.n_c:
            raise ValueError(
                f"contact: expected one of {self.scene.n_c}, counted from 0, got {self.contact!r}"
            )
        if not set(self.cyclic) <= set(range(self.scene.n_q)):
            raise ValueError(f"cyclic: expected coordinates below {self.scene.n_q}, got {self.cyclic!r}")
        object.__setattr__(self, "limit", limit_of(self.scene, self.limit))

    @property
    def driven(self) -> bool:
        """Whether points begin with the phase of the forcing."""
        return is_driven(self.scene)

    @property
    def columns(self) -> list[int]:
        """Which numbers of the state (q, v) points hold."""
        return [i for i in range(2 * self.scene.n_q) if i not in self.cyclic]

    def __call__(self, x: ArrayLike) -> Array:
        """The next event; NoReturn where there is none within the limit."""
        return self.point(self.next(x))

    def duration(self, x: ArrayLike) -> float:
        """Time to the next event: at a fixed point, the period of the orbit."""
        back = self.next(x)
        return back.time - back.start

    def advance(self, x: ArrayLike) -> Array:
        """By how much the coordinates that are left out move on, (len(cyclic),)."""
        state = self.next(x).state
        return np.array([state[i] - float(np.asarray(self.scene.q0)[i]) for i in self.cyclic])

    def entry(self) -> Array:
        """The first such event of the scene's own motion: a point to start from."""
        start = np.concatenate([self.scene.q0, self.scene.v0])
        return self.point(self.found(float(self.scene.t_span[0]), start))

    def next(self, x: ArrayLike) -> Return:
        """The next event with the motion that leads there."""
        x = checks.array("x", x, (self.driven + len(self.columns),))
        t = time_of(x[0], self.scene) if self.driven else 0.0
        state = np.concatenate([self.scene.q0, self.scene.v0]).astype(float)
        state[self.columns] = x[self.driven :]
        return self.found(t, state)

    def point(self, back: Return) -> Array:
        """The point of a return."""
        x = back.state[self.columns]
        return np.append(phase_of(back.time, self.scene), x) if self.driven else x

    def found(self, t: float, state: Array) -> Return:
        """The first event after the start, looked for in growing spans; the run ends with it."""
        limit = float(self.limit or 0.0)
        first = min(self.scene.period, self.scene.t_span[1] - self.scene.t_span[0])
        for wait in waits(first, limit):
            scene = self.started(state, (t, t + wait))
            for method in bounded(self.method):
                run = simulate(scene, method, keep="impacts")
                log, cut = run.impacts, run.status == Status.TOO_MANY_EVENTS
                of_kind = (log.kind == Kind[self.kind]) & (log.contact == self.contact)
                hits = np.flatnonzero(of_kind & (log.time > t + AT_ONCE * wait))
                if len(hits) and not (cut and run.t[-1] <= log.time[hits[0]]):
                    time = float(log.time[hits[0]])
                    row = int(np.searchsorted(run.t, time, side="right")) - 1
                    return Return(np.concatenate([run.q[row], run.v[row]]), time, t, run)
                if not cut:
                    break
            if run.status != Status.DONE:
                raise LcpStepError(f"the motion from x = {state.tolist()} ended early: {run.message}")
        raise NoReturn(state, limit, f"{self.kind} of contact {self.contact}")

    def started(self, state: Array, span: tuple[float, float]) -> Scene:
        """The scene from this state on."""
        n = self.scene.n_q
        return replace(self.scene, q0=state[:n], v0=state[n:], t_span=span, exact=None)

    def jacobian(self, x: ArrayLike) -> Array:
        """DP(x), (d, d)."""
        back = self.next(x)
        J, F_start, R, t_x = Walk(back.run).until(back.time)
        DP, t_x, shown = R @ J, t_x @ J, self.columns
        inner = DP[np.ix_(shown, shown)]
        if not self.driven:
            return np.asarray(inner)
        return with_phase(self.scene, inner, t_x[shown], float(t_x @ F_start), (DP @ F_start)[shown])
