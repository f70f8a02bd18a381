"""The Moreau theta-method for large sparse linear systems: the steps of `theta_method`, on whole vectors.

The step is solved for the change of the velocity, x = v+ - v, and the impulses p of the active contacts:

    A x = r + G^T p,      A = M + h theta C + h^2 theta^2 K
    r = h [theta F(t+h) + (1-theta) F(t)] - h C v - h K q - h^2 theta K v
    0 <= G x + c  complementary to  p >= 0,      c = G v + g_t + r_e u

by `lcp.saddle`, which starts from the contacts that carried an impulse in the step before and needs no dense matrix:
memory and time are about linear in the number of bodies where the graph of their connections is narrow.

A velocity that contact forces hold at zero up to rounding is zero, so that a pile at rest does not creep.
Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.17-3.34.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, checks
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.faults import cause
from lcpstep.kernels.function import Function
from lcpstep.kernels.layout import LEAD, TIME
from lcpstep.lcp.saddle import Point, Problem, Saddle
from lcpstep.model import c_functions, culprit
from lcpstep.recording import Kept, Recorder
from lcpstep.stepping import interpolation
from lcpstep.stepping.start import start_side
from lcpstep.stepping.steps import LATE, RESTING, divided, largest, unresolved
from lcpstep.trajectory import Counts, Kind, Status, Trajectory

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
BUFFER = 1 << 20  # numbers in the buffer of kept states
REST = 8 * np.finfo(float).eps  # of the size of a velocity's terms: zero
LOOKS = 50  # steps between two reports of progress
SOLVERS = ("lemke", "auto", "newton")  # names under which a sparse scene may ask for its own solver


class Equations:
    """The scene's sparse matrices, forces and gaps."""

    def __init__(self, scene: Scene) -> None:
        from scipy.sparse import csr_array

        system, contacts, n_q = scene.system, scene.contacts, scene.n_q
        if not isinstance(system, LinearSystem) or not (
            contacts is None or isinstance(contacts, LinearContacts)
        ):
            raise TypeError(f"scene: expected a linear system and flat contacts, got {scene.name!r}")
        matrices: Any = (system.M, system.C, system.K)
        self.M, self.C, self.K = (csr_array(x) for x in matrices)
        G: Any = np.zeros((0, n_q)) if contacts is None else contacts.G
        self.G = csr_array(G)
        self.offset = np.zeros(0) if contacts is None else np.array(contacts.offset)
        self.restitution = np.zeros(0) if contacts is None else np.array(contacts.restitution)
        self.p = np.array(scene.p)
        self.harmonic = system.force if isinstance(system.force, Harmonic) else None
        self.terms = (self.harmonic or Harmonic()).terms(n_q)
        motion = None if contacts is None else contacts.motion
        named = {"force": system.force, "frame": system.frame, "motion": motion}
        given = {name: f for name, f in named.items() if callable(f)}
        addresses, self.kept = c_functions(scene, system=given)
        shapes = {"force": (n_q,), "frame": (n_q, 3), "motion": (len(self.offset), 3)}
        self.callbacks = {
            name: Function(address, self.p, n_q, n_q, shapes[name])
            for name, address in addresses["system"].items()
        }

    def value(self, name: str, t: float, q: Array, v: Array, shape: tuple[int, ...]) -> Array:
        """Value of a callback."""
        out = np.full((1, *shape), np.nan)
        self.callbacks[name].sample(np.array([t]), np.ascontiguousarray(q), np.ascontiguousarray(v), out)
        return out[0]

    def force(self, t: float, q: Array, v: Array) -> Array:
        """F(t), the forces of a moving frame included."""
        n = len(q)
        if self.harmonic:
            constant, cosine, sine = self.terms
            angle = self.harmonic.omega * t
            F = constant + cosine * np.cos(angle) + sine * np.sin(angle)
        else:
            F = self.value("force", t, q, v, (n,))
        if "frame" in self.callbacks:
            c = self.value("frame", t, q, v, (n, 3))
            F = F - (self.M @ c[:, 2] + self.C @ c[:, 1] + self.K @ c[:, 0])
        return F

    def obstacle(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Position and velocity of the obstacles."""
        if "motion" not in self.callbacks:
            return np.zeros(len(self.offset)), np.zeros(len(self.offset))
        s = self.value("motion", t, q, v, (len(self.offset), 3))
        return s[:, 0], s[:, 1]


class Step:
    """Steps of one size h: their matrices, factorised once."""

    def __init__(self, equations: Equations, h: float, theta: float) -> None:
        e, self.h, self.theta = equations, h, theta
        A = e.M + h * theta * e.C + (h * theta) ** 2 * e.K
        self.saddle = Saddle(A, e.G)
        self.B = h * e.C + h * h * theta * e.K
        self.diagonal = A.diagonal()

    def free(self, e: Equations, q: Array, v: Array, F: Array, F_next: Array) -> Array:
        """Right-hand side r without contact."""
        average = self.theta * F_next + (1.0 - self.theta) * F
        return self.h * (average - e.K @ q) - self.B @ v

    def at_rest(self, v: Array, r: Array, p: Array) -> Array:
        """The velocities, zero where contact forces hold them there up to rounding."""
        pressed = self.saddle.abs_G_T @ p
        size = (pressed + np.abs(r)) / np.abs(self.diagonal)
        return np.where((pressed > 0.0) & (np.abs(v) <= REST * size), 0.0, v)


class Run:
    """One run of a sparse scene; see `moreau`, whose rules for steps, kept states and endings it obeys."""

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        if method.lcp not in SOLVERS:
            raise LcpStepError(
                f"lcp: scenes with sparse matrices have a solver of their own and take no {method.lcp!r}"
            )
        self.method, self.scene, self.kept = method, scene, kept
        self.equations = Equations(scene)
        size = largest(scene.q0, self.equations.offset, method.h * np.asarray(scene.v0))
        self.slack = RESTING * (size or 1.0)
        n_q, n_c = scene.n_q, scene.n_c
        self.q, self.v, self.t = np.array(scene.q0), np.array(scene.v0), scene.t_span[0]
        self.p, self.impulse = np.zeros(n_c), np.zeros(n_c)
        self.closed, self.active = np.zeros(n_c, dtype=np.int64), np.zeros(n_c, dtype=bool)
        self.recorder = Recorder(n_q, n_c, kept, max(1, BUFFER // (LEAD + 2 * n_q + n_c)))
        self.rows = self.events = self.all_events = self.steps = self.problems = self.forces = 0
        self.next_time, self.last_kept = 0, -np.inf

    def finish(self, progress: Callable[[float], None]) -> Trajectory:
        """Run to the end of the span, or to where it cannot go on."""
        status = Status.DONE
        try:
            self.begin()
            for h, start, first, last in divided(self.scene.t_span, self.method.h):
                step = Step(self.equations, h, self.method.theta)
                for k in range(last - first):
                    status = self.advance(step, start + h * k, start + h * (k + 1))
                    if status != Status.DONE:
                        break
                    if self.steps % LOOKS == 0:
                        progress(self.t)
                if status != Status.DONE:
                    break
        except KeyboardInterrupt:
            raise SimulationInterrupted(lambda: self.trajectory(Status.INTERRUPTED)) from None
        progress(self.t)
        error = cause() if status == Status.NOT_FINITE else None
        result = self.trajectory(status)
        if status == Status.NOT_FINITE:
            raise SimulationError(result.message, result) from error
        return result

    def begin(self) -> None:
        """Forces and gaps of the initial state, which is kept where states are."""
        side = start_side(self.scene, self.t)
        self.F = self.equations.force(side, self.q, self.v)
        self.forces += 1
        self.g, self.u = self.gaps(side, self.q, self.v)
        times = self.kept.times
        if len(times) == 0 or times[0] == self.t:
            self.keep(self.t, self.q, self.v)
            self.next_time = min(1, len(times))

    def gaps(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Gaps and gap velocities."""
        s, s_t = self.equations.obstacle(t, q, v)
        return self.equations.G @ q + self.equations.offset - s, self.equations.G @ v - s_t

    def advance(self, step: Step, t: float, t_next: float) -> Status:
        """One step from t to t_next."""
        e, theta = self.equations, step.theta
        F_next = e.force(t_next, self.q, self.v)
        self.forces += 1
        r = step.free(e, self.q, self.v, self.F, F_next)
        active = self.g + 0.5 * step.h * self.u <= self.slack
        _, s_t = e.obstacle(t_next, self.q, self.v)
        if not (np.all(np.isfinite(r)) and np.all(np.isfinite(s_t))):
            return Status.NOT_FINITE
        point = self.contact(step, r, active, s_t)
        if not point.solved:
            self.refused = np.flatnonzero(active)
            return Status.LCP_FAILED
        self.p, self.active = np.maximum(point.z, 0.0), active
        v = step.at_rest(self.v + point.x, r, self.p)
        q = self.q + step.h * (theta * v + (1.0 - theta) * self.v)
        happened = self.log(t_next, e.G @ v - s_t)
        self.keep_times(step.h, t, t_next, q, v)
        self.q, self.v, self.F, self.t = q, v, F_next, t_next
        self.g, self.u = self.gaps(t_next, q, v)
        self.steps += 1
        if not (np.all(np.isfinite(self.g)) and np.all(np.isfinite(self.u)) and np.all(np.isfinite(q))):
            return Status.NOT_FINITE
        if (self.kept.every and self.steps % self.kept.every == 0) or (self.kept.on_events and happened):
            self.keep(t_next, q, v)
        return Status.DONE

    def contact(self, step: Step, r: Array, active: Any, s_t: Array) -> Point:
        """Change of the velocity and impulses: those of the step before are tried first."""
        e, saddle = self.equations, step.saddle
        rebound = e.restitution * self.u
        size = saddle.abs_G @ np.abs(self.v) + np.abs(s_t) + np.abs(rebound)
        self.problems += bool(active.any())
        problem = Problem(r, e.G @ self.v - s_t + rebound, size, active)
        return saddle.solve(problem, (self.p > 0.0) | ~self.active, self.p)

    def log(self, t: float, u: Array) -> bool:
        """Note impacts, the beginning of lasting contact, and its end; whether there was any."""
        self.impulse += self.p
        pressed = self.p > 0.0
        kinds = np.full(len(self.p), -1)
        kinds[pressed & (self.closed == 0)] = Kind.IMPACT
        kinds[pressed & (self.closed == 1)] = Kind.STICK
        kinds[~pressed & (self.closed == 2)] = Kind.RELEASE
        self.closed = np.where(pressed, np.minimum(2, self.closed + 1), 0)
        noted = np.flatnonzero(kinds >= 0)
        lines = self.recorder.lines
        if self.events + len(noted) > len(lines):
            self.empty()
        at = slice(self.events, self.events + len(noted))
        columns = (np.full(len(noted), t), noted, self.u[noted], u[noted], self.p[noted], kinds[noted])
        lines[at] = np.column_stack(columns)
        self.events += len(noted)
        self.all_events += len(noted)
        return len(noted) > 0

    def keep_times(self, h: float, t: float, t_next: float, q: Array, v: Array) -> None:
        """Keep the states asked for within the step, q and v interpolated linearly."""
        times = self.kept.times
        while self.next_time < len(times) and times[self.next_time] <= t_next + LATE * h:
            at = times[self.next_time]
            share = min(1.0, (at - t) / (t_next - t))
            between = (1.0 - share) * self.q + share * q, (1.0 - share) * self.v + share * v
            self.keep(at, *between)
            self.next_time += 1

    def keep(self, t: float, q: Array, v: Array) -> None:
        """Keep a state; the impulses summed up to it start anew."""
        rows, n = self.recorder.rows, len(q)
        if self.rows == len(rows):
            self.empty()
        row = rows[self.rows]
        row[TIME], row[LEAD : LEAD + n], row[LEAD + n : LEAD + 2 * n] = t, q, v
        row[LEAD + 2 * n :] = self.impulse
        self.impulse[:] = 0.0
        self.rows, self.last_kept = self.rows + 1, t

    def empty(self) -> None:
        """Move what the buffers hold to the recorder's keeping."""
        self.recorder.empty(self.rows, self.events)
        self.rows = self.events = 0

    def trajectory(self, status: Status) -> Trajectory:
        """Everything computed so far."""
        if len(self.kept.times) == 0 and self.t > self.last_kept:
            self.keep(self.t, self.q, self.v)
        self.empty()
        kept = self.recorder.states()
        t = kept.t
        if len(t) and abs(t[-1] - self.scene.t_span[1]) <= unresolved(self.scene.t_span, self.method.h):
            t[-1] = self.scene.t_span[1]
        return Trajectory(
            scene=self.scene, method=self.method, t=t, q=kept.q, v=kept.v, impulse=kept.impulse,
            impacts=self.recorder.events(self.scene.t_span[1]), status=status, message=self.message(status),
            counts=Counts(
                steps=self.steps, lcp_calls=self.problems, force_evaluations=self.forces, events=self.all_events
            ),
            dense=interpolation.Linear(t, kept.q, kept.v, self.kept.all),
        )  # fmt: skip

    def message(self, status: Status) -> str:
        """How the run ended, in words."""
        if status == Status.DONE:
            return "reached the end of the span"
        where = f"at t = {self.t:.9g} s, q = {checks.shown(self.q)}, v = {checks.shown(self.v)}"
        if status == Status.INTERRUPTED:
            return f"interrupted {where}"
        if status == Status.LCP_FAILED:
            return f"no solution was found for the contacts {checks.shown(self.refused)} {where}"
        return f"{culprit(self.scene, (self.t, self.t + self.method.h), self.q, self.v)} {where}"
