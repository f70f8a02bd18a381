"""The Moreau theta-method for large sparse linear systems: the steps of `theta_method`, on whole vectors.

The step is solved for the change of the velocity, x = v+ - v, and the impulses p of the active contacts:

    A x = r + G^T p,      A = M + h theta C + h^2 theta^2 K
    r = h [theta F(t+h) + (1-theta) F(t)] - h C v - h K q - h^2 theta K v
    0 <= G x + c  complementary to  p >= 0,      c = G v + g_t + r_e u

by `lcp.saddle`, which starts from the contacts that carried an impulse in the step before and needs no dense matrix:
memory and time are about linear in the number of bodies where the graph of their connections is narrow.

Where some contacts separate while others strike, several such problems follow one another, see `blows`.
A velocity that contact forces hold at zero up to rounding is zero, so that a pile at rest does not creep.
Source: G. Osorio, Complex Behavior in Impacting Systems, eqs. 3.17-3.34.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Scene, checks
from lcpstep.gaps import no_way_out
from lcpstep.kernels.roundings import RESOLUTION
from lcpstep.lcp.saddle import Point, Problem
from lcpstep.recording import Kept, Recorder, States
from lcpstep.stepping import interpolation
from lcpstep.stepping.extent import own_places
from lcpstep.stepping.sparse.blows import Blows, forced, opens_and_closes
from lcpstep.stepping.sparse.equations import Equations, Step
from lcpstep.stepping.step_run import StepRun
from lcpstep.stepping.steps import LATE, RESTING, ROUNDING, TOUCHING, UNTOLD, largest, start_side
from lcpstep.trajectory import Counts, Kind, Status

if TYPE_CHECKING:
    from lcpstep.stepping.moreau import Moreau

Array = NDArray[np.float64]
DENSE = 1_000_000  # numbers in an array in which it is asked why a problem has no solution
PASSED = 1e-3  # of the rates before a blow
LEFT_OVER = 1e-4  # of the largest rate in a step: what its first blows have left has the digits of that
LOOKS = 50  # steps between two reports of progress
FEW = 100  # coordinates and contacts up to which dense steps are faster, being compiled, and know more
SOLVERS = ("lemke", "auto", "newton")  # names under which a sparse scene may ask for its own solver


class SparseRun(StepRun):
    """One run of a sparse scene; see `moreau`, whose rules for steps, kept states and endings it obeys."""

    steps, now = 0, 0.0  # taken; time of the current state [s]
    plan: Any = None

    def __init__(self, method: Moreau, scene: Scene, kept: Kept) -> None:
        n_q, n_c = scene.n_q, scene.n_c
        frictional = scene.contacts is not None and scene.contacts.friction is not None
        n = n_c * (2 if frictional else 1) + scene.n_j
        recorder = Recorder(n_q, n, kept)
        super().__init__(method, scene, kept, recorder, LOOKS)
        self.equations = Equations(scene)
        size = largest(scene.q0, method.h * np.asarray(scene.v0))
        self.slack = np.zeros(n_c)
        own_places(self.equations.offset, size, self.slack)
        self.slack *= RESTING
        self.q, self.v, self.now = np.array(scene.q0), np.array(scene.v0), scene.t_span[0]
        self.p, self.impulse = np.zeros(n_c), np.zeros(n)
        self.far = np.zeros(n_c)  # size of the largest terms of closed gaps since these closed
        self.closed, self.active = np.zeros(n_c, dtype=np.int64), np.zeros(n_c, dtype=bool)
        self.steps = self.problems = self.forces = 0

    @property
    def state(self) -> tuple[Array, Array]:
        """Last known q and v."""
        return self.q, self.v

    @property
    def counts(self) -> Counts:
        """Work done."""
        return Counts(self.steps, self.problems, self.forces, self.recorder.taken)

    def plan_for(self, h: float) -> Step:
        """What steps of size h multiply with."""
        return Step(self.equations, h, self.method.theta)

    def begin(self) -> int:
        """Forces and gaps of the initial state, which is kept where states are."""
        self.plan = self.plan_for(self.stretches[0][0])
        side = start_side(self.scene, self.now)
        self.F = self.equations.force(side, self.q, self.v)
        self.forces += 1
        self.g, self.u = self.gaps(side, self.q, self.v)
        self.note_touching()
        times = self.kept.times
        if len(times) == 0 or times[0] == self.now:
            self.keep(self.now, self.q, self.v)
            self.recorder.record.next_time = min(1, len(times))
        return Status.DONE

    def note_touching(self) -> None:
        """Contacts that begin at rest at next to no gap are closed up to that: see `theta_method.theta_loop`."""
        h, F = self.plan.h, np.abs(self.F)
        if self.equations.harmonic:
            F = np.maximum(F, sum(np.abs(term) for term in self.equations.terms))
        near = TOUCHING * h * largest(self.plan.saddle.free(h * F))
        if np.isfinite(near):
            rests = (np.abs(self.g) <= near) & (h * np.abs(self.u) <= near)
            self.slack = np.where(rests, np.maximum(self.slack, near), self.slack)

    def take(self, last: int) -> int:
        """Steps up to the one before `last`; why they ended."""
        status = Status.DONE
        while self.steps < last and status == Status.DONE:
            k = self.steps - self.first
            status = self.step(self.plan, self.t0 + self.plan.h * k, self.t0 + self.plan.h * (k + 1))
        return status

    def gaps(self, t: float, q: Array, v: Array) -> tuple[Array, Array]:
        """Gaps and gap velocities."""
        s, s_t = self.equations.obstacle(t, q, v)
        G = self.equations.G_rows
        return G.times(q) + self.equations.offset - s, G.times(v) - s_t

    def step(self, step: Step, t: float, t_next: float) -> Status:
        """One step from t to t_next."""
        e, theta = self.equations, step.theta
        F_next = e.force(t_next, self.q, self.v)
        self.forces += 1
        r = step.free(e, self.q, self.v, self.F, F_next)
        active = self.predict_active(step)
        _, s_t = e.obstacle(t_next, self.q, self.v)
        if not (np.all(np.isfinite(r)) and np.all(np.isfinite(s_t))):
            return Status.NOT_FINITE
        v, status = self.velocity(step, r, active, s_t, t, t_next)
        if status != Status.DONE:
            self.refused = np.flatnonzero(active)
            return status
        q = self.q + step.h * (theta * v + (1.0 - theta) * self.v)
        happened = self.log(t_next, e.G_rows.times(v) - s_t)
        self.keep_times(step.h, t, t_next, q, v)
        self.q, self.v, self.F, self.now = q, v, F_next, t_next
        self.g, self.u = self.gaps(t_next, q, v)
        self.steps += 1
        if not (np.all(np.isfinite(self.g)) and np.all(np.isfinite(self.u)) and np.all(np.isfinite(q))):
            return Status.NOT_FINITE
        if (self.kept.every and self.steps % self.kept.every == 0) or (self.kept.on_events and happened):
            self.keep(t_next, q, v)
        return Status.DONE

    def predict_active(self, step: Any) -> Any:
        """Contacts with g + (h/2) u <= 0, up to rounding; of closed ones up to what it may have opened them by.

        As `theta_step.predict_active`, which knows what impulses that cancel have left, too.
        """
        gap = self.g + 0.5 * step.h * self.u
        active = gap <= self.slack
        closed = self.closed > 0
        if not closed.any():
            self.far[:] = 0.0
            return active
        self.far = np.where(closed, np.maximum(self.far, self.equations.G_rows.sizes(self.q)), 0.0)
        in_doubt = np.flatnonzero(closed & ~active)
        if len(in_doubt):
            size = self.far[in_doubt]
            late = UNTOLD * np.abs(self.now * (self.equations.G_rows.times(self.v) - self.u)[in_doubt])
            active[in_doubt] = (
                gap[in_doubt] <= self.slack[in_doubt] + (RESTING + RESOLUTION * self.steps) * size + late
            )
        return active

    def velocity(
        self, step: Any, r: Array, active: Any, s_t: Array, t: float, t_next: float
    ) -> tuple[Array, Status]:
        """Velocity at the end of the step, the impulses found and added up; and how that went."""
        e, v, u, p = self.equations, self.v, self.u, np.zeros(len(s_t))
        push, free = r, step.saddle.free(r)
        blows = Blows(active, self.slow(step, free, active, s_t), e.restitution)
        while blows.follows(u):
            rebound = blows.rebound(u, e.restitution)
            point = self.contact(step, push, free, blows, v, s_t, rebound)
            v, p, before = v + point.x, p + np.maximum(point.z, 0.0), u + rebound
            u, push = e.G_rows.times(v) - s_t, np.zeros(len(v))
            if not point.solved or self.passes(blows.chosen, u + rebound, before, free):
                return self.v, Status.LCP_FAILED
            free = push
        self.p, self.active = p, active
        self.impulse += p
        return step.at_rest(v, r, p), Status.DONE

    def passes(self, chosen: Any, w: Array, before: Array, free: Array) -> bool:
        """Whether a blow leaves contacts that go on approaching: walls between which no impulse helps.

        w, before : (n_c,)   rates after and before it;  free : change of the velocity without contact
        """
        left = float(np.max(-w[chosen], initial=0.0))
        none = ROUNDING * float(np.max(self.equations.G_rows.sizes(self.v)[chosen], initial=0.0))
        if left <= max(none, PASSED * float(np.max(np.abs(before[chosen]), initial=0.0))):
            return False
        return left > PASSED * float(np.max(np.abs((before + self.equations.G_rows.times(free))[chosen])))

    def slow(self, step: Step, free: Array, active: Any, s_t: Array) -> float:
        """Speed beyond which contacts strike or separate, by `Blows`; -1 where they do not do both.

        free : change of the velocity without contact
        """
        if not opens_and_closes(self.u[active], 0.0):
            return -1.0
        e, v_free = self.equations, self.v + free
        speeds = forced(step, self.u, e.G_rows.times(v_free) - s_t, self.v, v_free, self.q)
        most = float(np.max(speeds[active]))
        return most if opens_and_closes(self.u[active], most) else -1.0

    def contact(
        self, step: Step, r: Array, free: Array, blows: Blows, v: Array, s_t: Array, rebound: Array
    ) -> Point:
        """Change of the velocity v and impulses: those of the step before are tried first, in its first blow."""
        e, saddle = self.equations, step.saddle
        active, size = blows.chosen, e.G_rows.sizes(v) + np.abs(s_t) + np.abs(rebound)
        self.problems += bool(active.any())
        c, likely, guess = e.G_rows.times(v) - s_t + rebound, (self.p > 0.0) | ~self.active, self.p
        if blows.taken > 1:
            size = np.maximum(size, LEFT_OVER * np.max(size))
            likely, guess = likely | (c < 0.0), np.zeros(len(c))
        return saddle.solve(Problem(r, c, size, active, free), likely, guess)

    def log(self, t: float, u: Array) -> bool:
        """Note impacts, the beginning of lasting contact, and its end; whether there was any."""
        pressed = self.p > 0.0
        kinds = np.full(len(self.p), -1)
        kinds[pressed & (self.closed == 0)] = Kind.IMPACT
        kinds[pressed & (self.closed == 1)] = Kind.STICK
        kinds[~pressed & (self.closed == 2)] = Kind.RELEASE
        self.closed = np.where(pressed, np.minimum(2, self.closed + 1), 0)
        noted = np.flatnonzero(kinds >= 0)
        lines, record = self.recorder.lines, self.recorder.record
        if record.event + len(noted) > len(lines):
            self.empty()
        at = slice(record.event, record.event + len(noted))
        columns = (np.full(len(noted), t), noted, self.u[noted], u[noted], self.p[noted], kinds[noted])
        lines[at] = np.column_stack(columns)
        record.event += len(noted)
        return len(noted) > 0

    def keep_times(self, h: float, t: float, t_next: float, q: Array, v: Array) -> None:
        """Keep the states asked for within the step, q and v interpolated linearly."""
        times, record = self.kept.times, self.recorder.record
        while record.next_time < len(times) and times[record.next_time] <= t_next + LATE * h:
            at = times[record.next_time]
            share = min(1.0, (at - t) / (t_next - t))
            between = (1.0 - share) * self.q + share * q, (1.0 - share) * self.v + share * v
            self.keep(at, *between)
            record.next_time += 1

    def keep(self, t: float, q: Array, v: Array) -> None:
        """Keep a state; the impulses summed up to it start anew."""
        self.recorder.keep(t, q, v, self.impulse)
        self.impulse[:] = 0.0

    def dense(self, s: States) -> interpolation.Linear:
        """How states between kept ones follow from them."""
        return interpolation.Linear(s.t, s.q, s.v, self.kept.all)

    def why(self, code: int) -> str:
        """Why the run ended early, in words."""
        if code == Status.LCP_FAILED:
            words = f"no solution was found for the contacts {checks.shown(self.refused)}"
            few = self.scene.n_q * len(self.refused) <= DENSE
            closes = (
                no_way_out(self.scene, self.now + self.plan.h, self.state[0], self.refused.tolist())
                if few
                else ""
            )
            return f"{closes or words} {self.where}"
        return super().why(code)
