"""The event-driven method: its parameters, and a run from a scene to a trajectory.

The loop over events is a kernel (`integrator.run`); this file chooses how the smooth motion is computed, prepares
the kernel's arrays, empties its buffers, and says in words how a run ended.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.compiled import compiled
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.events import dop853
from lcpstep.events import integrator as loop
from lcpstep.events.flow import FREE, MODE, N_NUMBERS, SCALE, Piece, closed_form_state, gap_speed_along
from lcpstep.events.oscillator import Oscillator, oscillator
from lcpstep.model import ABSENT, Model, culprit, model, require
from lcpstep.recording import Kept, Recorder, States
from lcpstep.trajectory import Counts, Status, Trajectory

Array = NDArray[np.float64]
PORTION = 4096  # steps between two looks at the outside world
TRIALS = 17  # of the callbacks within an interval that failed
QUADRATURE = 10  # nodes per interval of the contact forces' impulse
LEAST_TOLERANCE = 1e-14  # relative; below it rounding decides
# The scan for events must see every turn of the motion: intervals per period of each of its oscillations
PER_PERIOD, PER_FORCING, PER_SPAN = 10, 16, 50


@dataclass(frozen=True)
class EventDriven:
    """Integration from event to event: impacts, sticking, release, corners, chattering.

    Parameters
    ----------
    rtol, atol : tolerances of the smooth integration and of the chatter map (position [m]); at least 1e-14 for rtol
    max_events : bound on the number of events of a run

    Raises
    ------
    ValueError   a tolerance or the bound is out of range

    Notes
    -----
    One linear degree of freedom under constant and harmonic forces moves in closed form between events; all other
    systems by DOP853. The scene has one contact, or none.
    """

    rtol: float = 1e-12
    atol: float = 1e-12
    max_events: int = 10_000_000

    def __post_init__(self) -> None:
        object.__setattr__(self, "rtol", checks.number("rtol", self.rtol, least=LEAST_TOLERANCE, most=1.0))
        object.__setattr__(self, "atol", checks.positive("atol", self.atol))
        object.__setattr__(self, "max_events", int(checks.number("max_events", self.max_events, least=1)))

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene; see `lcpstep.simulate`."""
        require(scene, "EventDriven", joints=False, friction=False)
        if scene.n_c > 1:
            raise LcpStepError(
                f"scene: EventDriven takes scenes with one contact, {scene.name!r} has {scene.n_c}; use Moreau"
            )
        return _Run(self, scene, kept).finish(progress)


def flow(scene: Scene, m: Model, method: EventDriven) -> loop.Flow:
    """How the smooth motion of the scene is computed."""
    closed_form = None
    if m.linear and scene.n_q == 1 and m.flat and m.force == ABSENT:
        mass, damping, stiffness = (float(x[0, 0]) for x in (m.M, m.C, m.K))
        constant, cosine, sine = (float(x[0]) for x in (m.constant, m.cosine, m.sine))
        closed_form = oscillator(mass, damping, stiffness, constant, cosine, sine, m.omega)
    nodes, weights = np.polynomial.legendre.leggauss(QUADRATURE)
    return loop.Flow(
        nodes=0.5 * (1.0 + nodes),
        weights=0.5 * weights,
        closed_form=closed_form is not None,
        oscillator=closed_form or Oscillator(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        contact=scene.n_c > 0,
        scan=_scan(scene, closed_form),
        rtol=method.rtol,
        atol=method.atol,
        corners=np.array(scene.corners),
        period=scene.period,
        t_end=scene.t_span[1],
        max_events=method.max_events,
    )


def _scan(scene: Scene, o: Oscillator | None) -> float:
    """Longest interval on which the gap acceleration may be taken to change its sign only once."""
    candidates = [(scene.t_span[1] - scene.t_span[0]) / PER_SPAN, scene.period / PER_FORCING]
    if o is not None:
        rate = max(math.sqrt(abs(o.w2)), abs(o.delta), abs(o.Omega))
        candidates.append(2.0 * math.pi / PER_PERIOD / rate if rate > 0.0 else math.inf)
    return min(candidates)


def piece(scene: Scene, m: Model) -> Piece:
    """Work space of a piece of motion, at the initial state."""
    n_q, n_c = scene.n_q, max(scene.n_c, 1)
    x = np.zeros(N_NUMBERS)
    x[MODE] = FREE
    x[SCALE] = scene.period if math.isfinite(scene.period) else scene.t_span[1] - scene.t_span[0]
    q, v = np.array(scene.q0), np.array(scene.v0)
    return Piece(
        x=x, q0=q.copy(), v0=v.copy(), q=q, v=v, a=np.zeros(n_q), y=np.zeros(2 * n_q),
        G=np.zeros((n_c, n_q)), g_t=np.zeros(n_c), g=np.zeros(n_c), MG=np.zeros(n_q), M=np.zeros((n_q, n_q)),
        G_shifted=np.zeros((n_c, n_q)), g_t_shifted=np.zeros(n_c),
        q_shifted=np.zeros(n_q),
    )  # fmt: skip


class _Run:
    """One run: the kernel's arrays, and the portions that it is fed in."""

    def __init__(self, method: EventDriven, scene: Scene, kept: Kept) -> None:
        self.method, self.scene, self.kept = method, scene, kept
        self.model, self.fast = model(scene)
        self.flow = flow(scene, self.model, method)
        self.piece = piece(scene, self.model)
        self.never = NEVER_CLOSED_FORM if self.flow.closed_form else NEVER_RUNGE_KUTTA
        self.work = dop853.work(2 * scene.n_q)
        rows = PORTION + len(kept.times) + 2 * loop.SLACK
        self.recorder = Recorder(
            scene.n_q, scene.n_c, kept, rows, dense=kept.all and not self.flow.closed_form
        )
        self.count = np.zeros(loop.N_COUNTERS, dtype=np.int64)
        self.x = np.zeros(loop.N_NUMBERS)
        self.x[loop.NOW] = scene.t_span[0]
        self.x[loop.HOLD] = self.x[loop.LAST_EVENT] = -math.inf
        self.x[loop.NEXT_STEP] = 0.1 * self.flow.scan

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        run = compiled(loop.run, self.never) if self.fast else loop.run
        m, f, p, w, count, x = self.model, self.flow, self.piece, self.work, self.count, self.x
        record, tab = self.recorder.buffers, dop853.tableau()
        try:
            code = loop.FINISHED
            while code in (loop.FINISHED, loop.BUFFER_FULL) and x[loop.NOW] < f.t_end:
                try:
                    code = run(m, f, p, tab, w, record, count, x, int(count[loop.STEP]) + PORTION)
                except Exception as error:  # a callback in plain Python; compiled code raises nothing
                    message = f"a callback failed after t = {float(x[loop.NOW]):.9g} s: {error}"
                    raise SimulationError(message, self.trajectory(Status.NOT_FINITE)) from error
                self.empty()
                progress(float(x[loop.NOW]))
        except KeyboardInterrupt:
            raise SimulationInterrupted(self.trajectory(Status.INTERRUPTED)) from None
        result = self.trajectory(STATUS[code])
        if result.status == Status.NOT_FINITE:
            raise SimulationError(result.message, result)
        return result

    def empty(self) -> None:
        """Move the buffers' contents to the recorder, but for the last row, whose step is still to come."""
        rows = int(self.count[loop.ROW])
        self.recorder.empty(max(rows - 1, 0), int(self.count[loop.EVENT]))
        self.recorder.buffers.rows[0] = self.recorder.buffers.rows[max(rows - 1, 0)]
        self.count[loop.ROW], self.count[loop.EVENT] = min(rows, 1), 0

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        if (
            len(self.kept.times) == 0
            and self.x[loop.NOW] > self.recorder.buffers.rows[self.count[loop.ROW] - 1, 0]
        ):
            loop.keep(self.piece, self.recorder.buffers, self.count, self.x, float(self.x[loop.NOW]))
        self.recorder.empty(int(self.count[loop.ROW]), int(self.count[loop.EVENT]))
        s = self.recorder.states()
        count = self.count
        return Trajectory(
            scene=self.scene, method=self.method, t=s.t, q=s.q, v=s.v, impulse=s.impulse,
            impacts=self.recorder.events(), status=status, message=self.message(status),
            counts=Counts(
                steps=int(count[loop.STEP]), force_evaluations=int(count[loop.FORCES]),
                events=int(count[loop.EVENTS]),
            ),
            dense=self.dense_output(s),
        )  # fmt: skip

    def dense_output(self, s: States) -> Callable[[Array], tuple[Array, Array]]:
        """States at any time, from the kept ones and the pieces of motion that start there."""
        complete = self.kept.all or (self.flow.closed_form and self.kept.on_events)
        evaluate = compiled(loop.evaluate, self.never) if self.fast else loop.evaluate
        dense, n_q = self.recorder.dense(), self.scene.n_q

        def at(times: Array) -> tuple[Array, Array]:
            if not complete and not np.all(np.isin(times, s.t)):
                raise ValueError("t: states between the kept ones are not known; keep=1 keeps every step")
            row = np.maximum(np.searchsorted(s.t, times, side="right") - 1, 0)
            out = loop.Wanted(times, row, np.zeros((len(times), n_q)), np.zeros((len(times), n_q)))
            evaluate(
                self.model, self.flow, piece(self.scene, self.model), dop853.work(2 * n_q), s, dense, out
            )
            return out.q, out.v

        return at

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        if status == Status.DONE:
            return "reached the end of the span"
        now, end = float(self.x[loop.NOW]), float(self.x[loop.END])
        p = self.piece
        q, v = (p.q, p.v) if self.flow.closed_form else (p.q0, p.v0)
        where = f"at t = {now:.9g} s, q = {q.tolist()}, v = {v.tolist()}"
        if status == Status.TOO_MANY_EVENTS:
            return f"more than max_events = {self.method.max_events} events {where}"
        if status == Status.STEP_TOO_SMALL:
            return f"the tolerances rtol = {self.method.rtol:g}, atol = {self.method.atol:g} cannot be met {where}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        return f"{culprit(self.scene, np.linspace(now, end, TRIALS), q, v)} {where}"


# Kernels that one kind of smooth motion leaves aside
NEVER_CLOSED_FORM = (
    loop.runge_kutta_interval,
    loop.shorten,
    loop.project,
    dop853.interpolate,
    gap_speed_along,
)
NEVER_RUNGE_KUTTA = (loop.closed_form_interval, closed_form_state)
STATUS = {
    loop.FINISHED: Status.DONE,
    loop.NOT_FINITE: Status.NOT_FINITE,
    loop.TOO_MANY_EVENTS: Status.TOO_MANY_EVENTS,
    loop.STEP_TOO_SMALL: Status.STEP_TOO_SMALL,
}
