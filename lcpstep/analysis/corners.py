"""Corner impacts: where an impact of a periodic orbit meets a corner of the forcing, and the map around it.

With y the state (q, v) at the time t_c of the corner, as it would be there without the impact, a period of the
forcing is composed of three maps of the state and the parameter p,

    x -> y = F1(x, p)  to the corner,      y -> Z(y, p)  the impact,      -> F2(Z, p)  to the next section

where Z, the discontinuity map, takes no time: along the free flow to the surface H(y, p) = g(t_c, q) = 0, the impact
law R there, and back along the flow to t_c. On the side H < 0 the impact came before the corner and the flows are
those of the accelerations before it (Z-), on the side H > 0 of those after it (Z+):

    Z_y = R_y + (F+ - R_y F- - R_t) H_y / u-,      Z_p = R_p + (F+ - R_y F- - R_t) H_p / u-        on either side
    Z+_y - Z-_y = E H_y,   Z+_p - Z-_p = E H_p                           the corner correction, of rank one
    A = F2_y Z_y F1_x,   B = F2_y (Z_y F1_p + Z_p) + F2_p,   C = H_y F1_x,   D = H_y F1_p + H_p

so the impact falls before the corner where C dx + D dp < 0. R_p and H_p are derivatives at the corner as it moves
with the parameter. Source: G. Osorio, Complex Behavior in Impacting Systems, chapters 5 and 6 (eqs. 5.14-5.25 and
6.16-6.50); derived anew here, and checked by differences, for the printed forms contain sign errors.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import Scene, checks
from lcpstep.analysis.border_collision import PiecewiseLinearMap
from lcpstep.analysis.derivative import EIGHTH, differences, one_sided
from lcpstep.analysis.variation import flow, impact_law
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.maps.local import Local
from lcpstep.maps.stroboscopic import StroboscopicMap
from lcpstep.simulation import simulate
from lcpstep.trajectory import IMPACT_DTYPE, Kind, Status, Trajectory

Array = NDArray[np.float64]
Family = Callable[[float], Scene]
SIDE = 1e-9  # of the period: how far from a corner a jump of velocities is looked for
LIMIT = 1e-6  # of the period: steps of the extrapolation to a corner from either side
WIDE, NARROW = 4e-3, 2e-4  # steps of differences, relative: of free motion, and where there are other impacts
JUMP = 1e-6  # of the gap velocity, relative: a jump this large makes a corner one of degree one
SOFT = 1e-6  # of the largest gap velocity: an impact softer than this grazes
MAX_ITERATIONS = 30
STAGNATED = 1e-8


class NotDifferentiable(LcpStepError):
    """The orbit has a contact at which no derivative exists: grazing, sticking, or a corner of degree one."""


@dataclass(frozen=True, eq=False)
class CornerImpact:
    """A periodic orbit with an impact at a corner of the forcing.

    Attributes
    ----------
    make : p -> scene
    p : parameter at which it happens
    x : (2 n_q,)   state (q, v) on the section, at t = phase x period
    phase, periods : of the section; after how many periods the orbit repeats
    corner : index of the corner in scene.corners
    time : of the corner impact, counted as the section's t is [s]
    before, after : gap velocities at the corner impact [m/s]
    others : (m,)   times of the orbit's other impacts [s]
    residual : max |P^n(x) - x| and |g| at the corner
    """

    make: Family
    p: float
    x: Array
    phase: float
    periods: int
    corner: int
    time: float
    before: float
    after: float
    others: Array
    residual: float

    @property
    def scene(self) -> Scene:
        """The scene at the parameter of the corner impact."""
        return self.make(self.p)


def corner_impact(
    make: Family,
    p: float,
    x: ArrayLike,
    *,
    corner: int | None = None,
    n: int = 1,
    phase: float = 0.0,
    method: EventDriven | None = None,
) -> CornerImpact:
    """The parameter and the periodic orbit at which an impact falls on a corner, by Newton's method.

    Parameters
    ----------
    make : p -> scene with one contact, a period and corners
    p, x : guess of the parameter and of the state (q, v) on the section, for example from `periodic_orbit`
    corner : index in scene.corners; where not given, the one nearest to an impact of the guess
    n : periods after which the orbit repeats
    phase : of the section, as a share of the period; no impact of the orbit may lie on it

    Raises
    ------
    ValueError   a scene without corners, an unknown corner, a guess without impacts
    NotDifferentiable   a corner of degree one (velocity jump), or an orbit with grazing or sticking
    LcpStepError   no such orbit near the guess
    """
    scene = make(checks.number("p", p))
    if np.size(scene.corners) == 0 or scene.n_c != 1 or not math.isfinite(scene.period):
        raise ValueError(
            f"make: expected scenes with one contact, a period and corners, {scene.name!r} has not all"
        )
    x = np.array(checks.array("x", x, (2 * scene.n_q,)))
    pieces = _Pieces(make, method or EventDriven(), phase, checks.count("n", n))
    pieces.aim(p, x, corner)
    size = np.append(np.maximum(1.0, np.abs(x)), 1.0)
    z, before, best = np.append(x, p), math.inf, np.append(x, p)
    for _ in range(MAX_ITERATIONS):
        F = pieces.closing(z)
        error = float(np.max(np.abs(F) / size))
        if error >= 0.5 * before and before <= STAGNATED:  # down to its rounding
            return pieces.described(best, before)
        if not error < 10.0 * before:
            break
        before, best = error, z
        z = z - np.linalg.solve(differences(pieces.closing, z), F)
    raise LcpStepError(
        f"no periodic orbit with an impact at corner {pieces.corner} near p = {p:.9g}: residual {error:.3g}"
    )


@dataclass(frozen=True, eq=False)
class DiscontinuityMap:
    """The impact as a map of the state at the corner that takes no time, to first order.

    Attributes
    ----------
    y, image : (2 n_q,)   state at the corner before and after the impact
    minus_y, plus_y : (2 n_q, 2 n_q)   derivatives by the state, for the impact before and after the corner
    minus_p, plus_p : (2 n_q,)   derivatives by the parameter
    H_y, H_p : (2 n_q,) and number   derivatives of the gap at the corner
    """

    y: Array
    image: Array
    minus_y: Array
    plus_y: Array
    minus_p: Array
    plus_p: Array
    H_y: Array
    H_p: float

    @property
    def correction(self) -> tuple[Array, Array]:
        """The corner correction: what is added to (minus_y, minus_p) when the impact moves behind the corner."""
        return self.plus_y - self.minus_y, self.plus_p - self.minus_p


def discontinuity_map(orbit: CornerImpact, method: EventDriven | None = None) -> DiscontinuityMap:
    """The discontinuity map of a corner impact with its derivatives on both sides; see the head of the file."""
    pieces = _Pieces.of(orbit, method or EventDriven())
    y = pieces.to_corner(orbit.x, orbit.p)
    n, p = len(y) // 2, orbit.p
    scene = orbit.scene
    local, t = Local(scene), pieces.corner_time(p)
    q, v = y[:n], y[n:]
    image = np.concatenate([q, local.after_impact(t, q, v)])
    G, u = local.rates(t, q, v)
    H_y = np.concatenate([G, np.zeros(n)])
    H_p = float(differences(lambda s: pieces.gap(y, float(s[0])), np.array([p]), WIDE, EIGHTH)[0, 0])
    R_p = differences(lambda s: pieces.rebound(y, float(s[0])), np.array([p]), WIDE, EIGHTH)[:, 0]
    R_y, _ = impact_law(local, t, q, v)

    def surplus(at: float) -> Array:
        """(F+ - R_y F- - R_t) / u- with the accelerations of the time `at`."""
        _, R_t = impact_law(local, at, q, v)
        F_before = np.concatenate([v, local.acceleration(at, q, v)])
        F_after = np.concatenate([image[n:], local.acceleration(at, q, image[n:])])
        return np.asarray((F_after - R_y @ F_before - R_t) / u)

    found = []
    for side in (-1.0, 1.0):
        limit = one_sided(surplus, t, side * min(LIMIT * scene.period, 0.1 * pieces.clear(scene)))
        found.append((R_y + np.outer(limit, H_y), R_p + limit * H_p))
    (minus_y, minus_p), (plus_y, plus_p) = found
    return DiscontinuityMap(y, image, minus_y, plus_y, minus_p, plus_p, H_y, H_p)


def local_map(
    orbit: CornerImpact, method: EventDriven | None = None, *, step: float | None = None
) -> PiecewiseLinearMap:
    """The piecewise-linear map around a corner impact by the chain rule, in x - orbit.x and p - orbit.p.

    step : of the differences that the flows to the corner and on are derived with, relative to state and parameter;
        4e-3 where not given, or 2e-4 where the orbit has other impacts. Another step tells what is rounding.
    """
    step = step or (NARROW if len(orbit.others) else WIDE)
    pieces = _Pieces.of(orbit, method or EventDriven())
    Z = discontinuity_map(orbit, method)
    d = len(orbit.x)

    def first(z: Array) -> Array:
        return pieces.to_corner(z[:d], float(z[d]))

    def second(z: Array) -> Array:
        return pieces.from_corner(z[:d], float(z[d]))

    F1 = differences(first, np.append(orbit.x, orbit.p), step, EIGHTH)
    F2 = differences(second, np.append(Z.image, orbit.p), step, EIGHTH)
    F1_x, F1_p, F2_y, F2_p = F1[:, :d], F1[:, d], F2[:, :d], F2[:, d]
    if (
        not len(orbit.others) and Local(orbit.scene).model.linear
    ):  # the flow of a linear system is known exactly
        at = pieces.corner_time(orbit.p)
        start, end = (share * orbit.scene.period for share in (pieces.phase, pieces.phase + pieces.n))
        F1_x, F2_y = flow(orbit.scene, at - start), flow(orbit.scene, end - at)
    return PiecewiseLinearMap(
        A_minus=F2_y @ Z.minus_y @ F1_x,
        A_plus=F2_y @ Z.plus_y @ F1_x,
        B_minus=F2_y @ (Z.minus_y @ F1_p + Z.minus_p) + F2_p,
        B_plus=F2_y @ (Z.plus_y @ F1_p + Z.plus_p) + F2_p,
        C=Z.H_y @ F1_x,
        D=float(Z.H_y @ F1_p) + Z.H_p,
    )


class _Pieces:
    """The motion of a family of scenes in three parts: to the corner, through the impact, and on to the section."""

    def __init__(self, make: Family, method: EventDriven, phase: float, n: int) -> None:
        self.make, self.method, self.phase, self.n = make, method, phase, n
        self.corner, self.turn = 0, 0
        self.pauses = (phase, phase + n)  # phases between which the motion is free but for the corner impact

    @classmethod
    def of(cls, orbit: CornerImpact, method: EventDriven) -> _Pieces:
        pieces = cls(orbit.make, method, orbit.phase, orbit.periods)
        pieces.corner = orbit.corner
        T = orbit.scene.period
        pieces.turn = round((orbit.time - float(np.asarray(orbit.scene.corners)[orbit.corner])) / T)
        pieces.pause(orbit.time / T, orbit.others / T)
        return pieces

    def aim(self, p: float, x: Array, corner: int | None) -> None:
        """Which impact of the motion from x meets which corner."""
        scene = self.make(p)
        T = scene.period
        run = self.run(scene, x, self.phase * T, (self.phase + self.n) * T)
        if np.any(run.impacts.kind != Kind.IMPACT):
            raise NotDifferentiable("the contact closes for good on the orbit (chattering or sticking)")
        times, speeds = run.impacts.time / T, np.abs(run.impacts.before)
        if len(times) == 0:
            raise ValueError(f"x: the motion from {x.tolist()} has no impact within {self.n} periods")
        corners = np.asarray(scene.corners) / T
        if corner is not None and not 0 <= corner < len(corners):
            raise ValueError(f"corner: expected an index below {len(corners)}, got {corner!r}")
        distance = (times[:, None] - corners[None, :] + 0.5) % 1.0 - 0.5
        if corner is not None:
            distance[:, [k for k in range(len(corners)) if k != corner]] = np.inf
        i, self.corner = (int(k) for k in np.unravel_index(np.argmin(np.abs(distance)), distance.shape))
        self.turn = round(times[i] - distance[i, self.corner] - corners[self.corner])
        if np.min(speeds) < SOFT * np.max(speeds):
            raise NotDifferentiable("an impact of the orbit grazes: its speed is zero to rounding")
        self.pause(corners[self.corner] + self.turn, np.delete(times, i))
        self.check_degree(scene)

    def pause(self, at: float, others: Array) -> None:
        """Phases half way from the corner impact to its neighbours, or to the section."""
        left = max([self.phase, *others[others < at]])
        right = min([self.phase + self.n, *others[others > at]])
        self.pauses = (left if left == self.phase else 0.5 * (left + at), 0.5 * (right + at))

    def check_degree(self, scene: Scene) -> None:
        """The gap velocity must be continuous at the corner."""
        t = (float(np.asarray(scene.corners)[self.corner])) + self.turn * scene.period
        q, v, p = (np.asarray(x, dtype=float) for x in (scene.q0, scene.v0, scene.p))
        early, late = (scene.gap(t + s * SIDE * scene.period, q, v)[1][0] for s in (-1.0, 1.0))
        jump = abs(late - early)
        frame = getattr(scene.system, "frame", None)
        if frame is not None:
            before, after = (
                checks.evaluate("frame", frame, (t + s * SIDE * scene.period, q, v, p), (scene.n_q, 3))
                for s in (-1.0, 1.0)
            )
            jump = max(jump, float(np.max(np.abs(after[:, 1] - before[:, 1]))))
        if jump > JUMP * max(1.0, abs(early)):
            raise NotDifferentiable(
                f"corner {self.corner} is of degree one: the velocity jumps by {jump:.3g} there, where only the "
                f"acceleration may"
            )

    def corner_time(self, p: float) -> float:
        """When the corner comes at the parameter p [s]."""
        scene = self.make(p)
        return float(np.asarray(scene.corners)[self.corner]) + self.turn * scene.period

    def clear(self, scene: Scene) -> float:
        """How far it is from the corner to the nearest other one [s]."""
        corners = np.asarray(scene.corners) / scene.period
        away = np.abs((np.delete(corners, self.corner) - corners[self.corner] + 0.5) % 1.0 - 0.5)
        return float(np.min(away, initial=1.0)) * scene.period

    def to_corner(self, x: Array, p: float) -> Array:
        """F1: the state at the corner, as it would be there without the impact."""
        scene = self.make(p)
        start, rest = self.phase * scene.period, self.pauses[0] * scene.period
        return self.free(scene, self.moved(scene, x, start, rest), rest, self.corner_time(p))

    def from_corner(self, y: Array, p: float) -> Array:
        """F2: from the state at the corner, after the impact, to the section."""
        scene = self.make(p)
        rest, end = self.pauses[1] * scene.period, (self.phase + self.n) * scene.period
        return self.moved(scene, self.free(scene, y, self.corner_time(p), rest), rest, end)

    def gap(self, y: Array, p: float) -> Array:
        """H: the gap of the state y at the corner, (1,)."""
        scene, n = self.make(p), len(y) // 2
        return np.asarray(scene.gap(self.corner_time(p), y[:n], y[n:])[0])

    def rebound(self, y: Array, p: float) -> Array:
        """R: the state y after an impact at the corner."""
        n = len(y) // 2
        v = Local(self.make(p)).after_impact(self.corner_time(p), y[:n], y[n:])
        return np.concatenate([y[:n], v])

    def closing(self, z: Array) -> Array:
        """What must vanish: the state after n periods less that at the start, and the gap at the corner."""
        x, p = z[:-1], float(z[-1])
        y = self.to_corner(x, p)
        return np.append(self.from_corner(self.rebound(y, p), p) - x, self.gap(y, p))

    def described(self, z: Array, residual: float) -> CornerImpact:
        x, p = z[:-1], float(z[-1])
        scene, t = self.make(p), self.corner_time(p)
        n = len(x) // 2
        y = self.to_corner(x, p)
        u = float(scene.gap(t, y[:n], y[n:])[1][0])
        image = self.rebound(y, p)
        after = float(scene.gap(t, image[:n], image[n:])[1][0])
        T = scene.period
        late = self.free(scene, image, t, self.pauses[1] * T)
        first = self.impacts(scene, x, self.phase * T, self.pauses[0] * T)
        last = self.impacts(scene, late, self.pauses[1] * T, (self.phase + self.n) * T)
        others = np.concatenate([first["time"], last["time"]])
        speeds = np.concatenate([first["before"], last["before"], [u]])
        if u >= 0.0 or np.min(np.abs(speeds)) < SOFT * np.max(np.abs(speeds)):
            raise NotDifferentiable("an impact of the orbit grazes: its speed is zero to rounding")
        return CornerImpact(self.make, p, x, self.phase, self.n, self.corner, t, u, after, others, residual)

    def impacts(self, scene: Scene, x: Array, a: float, b: float) -> Any:
        """The impact log of the motion from x at a."""
        return self.run(scene, x, a, b).impacts if b > a else np.zeros(0, dtype=IMPACT_DTYPE)

    def moved(self, scene: Scene, x: Array, a: float, b: float) -> Array:
        """The state at b of the motion with contacts from x at a."""
        if b <= a:
            return x
        run = self.run(scene, x, a, b)
        return np.concatenate([run.q[-1], run.v[-1]])

    def free(self, scene: Scene, x: Array, a: float, b: float) -> Array:
        """The state at b of the motion without contacts from x at a."""
        return self.moved(replace(scene, contacts=None), x, a, b)

    def run(self, scene: Scene, x: Array, a: float, b: float) -> Trajectory:
        """The motion from x at a."""
        n = scene.n_q
        run = simulate(replace(scene, q0=x[:n], v0=x[n:], t_span=(a, b), exact=None), self.method, keep=[b])
        if run.status != Status.DONE:
            raise LcpStepError(f"the motion from x = {x.tolist()} at t = {a:g} s ended early: {run.message}")
        return run


@dataclass(frozen=True, eq=False)
class Estimate:
    """The local map from simulated perturbations.

    Attributes
    ----------
    map : PiecewiseLinearMap   C and D are those of the chain rule: a fit knows the sides only by where points fell
    rms : (minus, plus)   residual of the fit, relative to the deviations' images
    points : (minus, plus)   how many perturbations fell on each side
    """

    map: PiecewiseLinearMap
    rms: tuple[float, float]
    points: tuple[int, int]


def estimate(
    orbit: CornerImpact,
    border: PiecewiseLinearMap,
    *,
    size: float = 1e-3,
    samples: int = 60,
    seed: int = 0,
    method: EventDriven | None = None,
) -> Estimate:
    """A and B by least squares on perturbations of the event-driven run, quadratic terms fitted along.

    Parameters
    ----------
    orbit, border : the corner impact, and a map whose C and D say on which side a perturbation falls
    size : of the perturbations: relative to the state and the parameter
    samples : perturbations on each side
    seed : of their random directions

    Raises
    ------
    LcpStepError   too few perturbations fell on one side
    """
    rng = np.random.default_rng(seed)
    d = len(orbit.x)
    scale = size * np.append(np.maximum(np.abs(orbit.x), np.max(np.abs(orbit.x)) * 1e-2), abs(orbit.p))
    C, D = np.asarray(border.C), border.D
    # Deviations are balanced so that the border cuts them through the middle.
    weights = np.abs(np.append(C, D)) * scale
    least = float(np.min(weights[weights > 0.0]))
    scale = scale * np.minimum(1.0, least / np.maximum(weights, least))
    fits, rms, counts = [], [], []
    for side in (-1.0, 1.0):
        deviations: list[Array] = []
        while len(deviations) < samples:
            z = scale * rng.uniform(-1.0, 1.0, d + 1)
            place = float(C @ z[:d] + D * z[d])
            deviations.append(z if place * side > 0.0 else -z)
        Z = np.array(deviations)
        images = np.array([_image(orbit, z, method or EventDriven()) for z in Z])
        terms = Z / scale
        squares = [terms[:, i] * terms[:, j] for i in range(d + 1) for j in range(i, d + 1)]
        cubes = [squares[k] * terms[:, i] for k in range(len(squares)) for i in range(d + 1)]
        M = np.column_stack([terms, *squares, *cubes])
        solution = np.linalg.lstsq(M, images, rcond=1e-13)[0]
        left = images - M @ solution
        rms.append(float(np.sqrt(np.mean(left**2)) / np.sqrt(np.mean(images**2))))
        fits.append((solution[: d + 1] / scale[:, None]).T)
        counts.append(samples)
    found = PiecewiseLinearMap(
        fits[0][:, :d], fits[1][:, :d], fits[0][:, d], fits[1][:, d], border.C, border.D
    )
    return Estimate(found, (rms[0], rms[1]), (counts[0], counts[1]))


def _image(orbit: CornerImpact, z: Array, method: EventDriven) -> Array:
    """Deviation from the orbit after its periods of the motion that starts with the deviation z = (dx, dp)."""
    P = StroboscopicMap(orbit.make(orbit.p + float(z[-1])), method, orbit.phase)
    return np.asarray(P.follow(orbit.x + z[:-1], orbit.periods).states[0, -1] - orbit.x)


def agreement(one: PiecewiseLinearMap, other: PiecewiseLinearMap) -> float:
    """Largest difference of the matrices of two maps, relative to the largest entry of each."""
    worst = 0.0
    for name in ("A_minus", "A_plus", "B_minus", "B_plus"):
        a, b = np.asarray(getattr(one, name)), np.asarray(getattr(other, name))
        worst = max(worst, float(np.max(np.abs(a - b)) / np.max(np.abs(b))))
    return worst
