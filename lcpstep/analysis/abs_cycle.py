"""The limit cycle of the hybrid anti-lock controller: switching states, multiplier, basins, bifurcations.

The cycle is dead-beat: in state 1 the torque is T_max and the slip leaves at lambda_max whatever came before, so
the state (lambda_max, T_max) lies on it, and all deviations are lost there: the multiplier is zero. It exists while,
from there on, none of the four states of the machine ends on the isocline T_b = Psi(lambda) or with a locked wheel.
Source: G. Osorio, Complex Behavior in Impacting Systems, chapter 7.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from dataclasses import replace as changed
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lagrangian.hybrid import HybridScene
from lagrangian.scenes.hybrid_abs import SLIP_MAX, T_MAX, holding_torque, holding_torque_slope
from lcpstep.analysis.hybrid_variation import monodromy
from lcpstep.errors import LcpStepError, StudyInterrupted
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.many import End, Follower
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.simulation import simulate
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
FINEST = 4.0 * np.finfo(float).eps  # relative, of a bisection
ORDER = ("2", "3", "0", "1")  # states from (lambda_max, T_max) on
OUTCOMES = ("limit cycle", "wheel lock", "equilibrium", "other")
CYCLE, LOCK, EQUILIBRIUM, OTHER = range(4)
LONGEST, SETTLED = 100.0, 10.0  # a motion that does not switch for so long: of the cycle, of basins [s]
SWITCHES = 14  # after which a motion that goes on is compared with the cycle
NEAR = 1e-4  # of two switching states that are the same, relative; at the tolerances of basins
NEARLY_LOCKED = 0.99  # slip, in the model that does not reach 1
FAST, EXACT = EventDriven(rtol=1e-9, atol=1e-9), EventDriven(rtol=1e-12, atol=1e-13)


class NoCycle(LcpStepError):
    """There is no limit cycle; `outcome` says where the motion goes in its place."""

    def __init__(self, message: str, outcome: str) -> None:
        super().__init__(message)
        self.outcome = outcome


@dataclass(frozen=True, eq=False)
class Cycle:
    """The limit cycle.

    Attributes
    ----------
    states : (4,) states of the machine in the order they are entered, from (lambda_max, T_max) on
    times : (4,)   when each is entered [s]
    slip, torque : (4,)   there [-], [N m]
    period : [s]
    slip_range, torque_range : smallest and largest value along the cycle
    monodromy : (2, 2)   derivative of the state after a period by the state before, entering state 2
    multiplier : the eigenvalue of it that is not the one along the motion; zero for a dead-beat cycle
    multiplier_by_differences : the same from the return map of the slip on T_b = T_min, by differences
    """

    states: tuple[str, ...]
    times: Array
    slip: Array
    torque: Array
    period: float
    slip_range: tuple[float, float]
    torque_range: tuple[float, float]
    monodromy: Array
    multiplier: float
    multiplier_by_differences: float

    def as_dict(self) -> dict[str, Any]:
        """The same for a file."""
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in asdict(self).items()}


def limit_cycle(scene: HybridScene, method: EventDriven = EXACT) -> Cycle:
    """The limit cycle of a scene of `lagrangian.scenes.hybrid_abs` with one of the reduced models.

    Raises
    ------
    NoCycle   the motion from (lambda_max, T_max) does not come back; says where it goes
    """
    start = corner(scene)
    end = Follower(scene, method, LONGEST, 4)(start, "2")
    if not returns(end, start):
        where = outcome(scene, end)
        raise NoCycle(f"no limit cycle: from slip {start[0]:g} and torque {start[1]:g} N m {where}", where)
    period = float(end.times[-1])
    run = simulate(scene.started(start, "2", (0.0, period)), method)
    M = monodromy(_whole(run, end))
    values = np.linalg.eigvals(M)
    other = values[np.argmax(np.abs(values - 1.0))]
    lowest, highest = _extremes(run.at, period)
    return Cycle(
        ORDER, np.concatenate([[0.0], end.times[:3]]), np.concatenate([[start[0]], end.after[:3, 0]]),
        np.concatenate([[start[1]], end.after[:3, 1]]), period, (lowest, highest),
        (float(np.min(end.after[:, 1])), float(np.max(end.after[:, 1]))), M, float(other.real),
        _slope_of_return(scene, method, end.after[0]),
    )  # fmt: skip


def corner(scene: HybridScene) -> Array:
    """(lambda_max, T_max), where state 2 is entered."""
    if scene.system.n_x != 2:
        raise LcpStepError("scene: a limit cycle needs a reduced model; in the full one the speed falls")
    p = np.asarray(scene.p)
    return np.array([p[SLIP_MAX], p[T_MAX]])


def returns(end: End, start: Array) -> bool:
    """Whether the four states followed each other, back to the start."""
    return end.modes == [*ORDER[1:], ORDER[0]] and bool(np.all(np.abs(end.after[-1] - start) <= NEAR * start))


def _whole(run: Any, end: End) -> Any:
    """The run over one period, whose last switch falls on the end of the span or a rounding after it."""
    if len(run.switches) == 4:
        return run
    return simulate(changed(run.scene, t_span=(0.0, run.scene.t_span[1] * (1.0 + 1e-13))), run.method)


def _extremes(at: Callable[[Any], Array], period: float) -> tuple[float, float]:
    from scipy.optimize import minimize_scalar

    t = np.linspace(0.0, period, 2001)
    slip, found = at(t)[:, 0], []
    for sign in (1.0, -1.0):
        k = int(np.argmin(sign * slip))
        bounds = (t[max(k - 1, 0)], t[min(k + 1, len(t) - 1)])
        best = minimize_scalar(lambda s, sign=sign: sign * at(s)[0], bounds=bounds, options={"xatol": 1e-12})
        found.append(sign * min(float(best.fun), sign * float(slip[k]), sign * float(slip[0])))
    return found[0], found[1]


def _slope_of_return(scene: HybridScene, method: EventDriven, x: Array) -> float:
    """Derivative of the slip at which T_min is reached by that of one turn before."""
    follow, d = Follower(scene, method, LONGEST, 4), 1e-3
    images = [follow(np.array([x[0] + s * d, x[1]]), "3").after[-1, 0] for s in (1.0, -1.0)]
    return float((images[0] - images[1]) / (2.0 * d))


def outcome(scene: HybridScene, end: End) -> str:
    """What a motion ended in, in words."""
    label = OUTCOMES[classify(scene, end)]
    return {
        "limit cycle": "it comes back",
        "wheel lock": f"the wheel locks in state {end.mode[0]}",
        "equilibrium": f"it comes to rest on the isocline in state {end.mode[0]}, at slip {end.x[0]:.6g}",
        "other": f"it goes to slip {end.x[0]:.6g}, torque {end.x[1]:.6g} N m in state {end.mode}",
    }[label]


def classify(scene: HybridScene, end: End) -> int:
    """CYCLE, LOCK, EQUILIBRIUM or OTHER, from the end of a long run."""
    if end.status == Status.TOO_MANY_EVENTS and len(end.times) >= 8:
        same = np.abs(end.after[-4:] - end.after[-8:-4]) <= NEAR * np.abs(end.after[-4:])
        return CYCLE if np.all(same) and "locked" not in " ".join(end.modes[-4:]) else OTHER
    if end.status != Status.DONE or end.mode[0] not in "13":
        return OTHER
    if "locked" in end.mode or end.x[0] > NEARLY_LOCKED:
        return LOCK
    p = np.asarray(scene.p)
    rest = abs(holding_torque(end.x[0], p) - end.x[1]) <= NEAR * max(end.x[1], 1.0)
    return EQUILIBRIUM if rest else OTHER


def peak(scene: HybridScene) -> tuple[float, float]:
    """Slip at the largest holding torque, where dPsi/dlambda = 0, and max Psi [N m].

    Raises
    ------
    LcpStepError   Psi rises all the way to a locked wheel
    """
    from scipy.optimize import brentq

    p = np.asarray(scene.p)
    if not holding_torque_slope(1.0, p) < 0.0 < holding_torque_slope(0.0, p):
        raise LcpStepError("Psi has no maximum between rolling and a locked wheel")
    slip = float(
        brentq(holding_torque_slope, 0.0, 1.0, args=(p,), xtol=1e-17, rtol=4.0 * np.finfo(float).eps)
    )
    return slip, holding_torque(slip, p)


def with_thresholds(scene: HybridScene, **values: float) -> HybridScene:
    """The scene with other parameters, by name: torque_max, slip_min, ..."""
    names = [k for k, v in scene.parameters.items() if not isinstance(v, str)]
    p = np.array(scene.p)
    for name, value in values.items():
        p[names.index(name)] = value
    return changed(scene, p=p, parameters=dict(scene.parameters) | values)


def has_cycle(scene: HybridScene, longest: float = LONGEST) -> bool:
    """Whether the motion from (lambda_max, T_max) comes back to it within a time [s]."""
    start = corner(scene)
    return returns(Follower(scene, EXACT, longest, 4)(start, "2"), start)


def edge(exists: Callable[[float], bool], inside: float, outside: float, width: float) -> float:
    """Where a property that holds at `inside` and not at `outside` is lost, by bisection to a width."""
    if not exists(inside) or exists(outside):
        raise ValueError(f"edge: expected the cycle at {inside:g} and none at {outside:g}")
    from scipy.optimize import bisect

    return float(bisect(lambda x: 1.0 if exists(x) else -1.0, inside, outside, xtol=0.5 * width, rtol=FINEST))


def vanishing(scene: HybridScene, width: float = 2e-10, longest: float = 1e7) -> float:
    """The largest torque threshold T_max [N m] below which the cycle has vanished.

    The time to pass the top of Psi grows as 1/sqrt(T_max - max Psi) as T_max comes down to it; `longest` [s] is
    waited for that.
    """
    top = peak(scene)[1]
    inside = float(scene.parameters["torque_max"])
    low = max(0.5 * (top + float(scene.parameters["torque_min"])), top - 10.0)
    return edge(lambda T: has_cycle(with_thresholds(scene, torque_max=T), longest), inside, low, width)


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """The cycle over the torque threshold: T_max (m,), period, smallest and largest slip; NaN where there is none."""

    torque_max: Array
    period: Array
    slip_low: Array
    slip_high: Array
    entered: Array  # (m, 4) slip at the four switches, from state 2 on

    def as_dict(self) -> dict[str, Any]:
        """The same for a file."""
        return {
            k: [None if v != v else v for v in x.tolist()] if x.ndim == 1 else x.tolist()
            for k, x in vars(self).items()
        }


def bifurcation(scene: HybridScene, torque_max: ArrayLike) -> Bifurcation:
    """Period and amplitude of the cycle for each torque threshold."""
    values = checks.vector("torque_max", torque_max)
    rows = []
    for T in values:
        other = with_thresholds(scene, torque_max=float(T))
        start = corner(other)
        end = Follower(other, EXACT, LONGEST, 4)(start, "2")
        if not returns(end, start):
            rows.append(np.full(7, np.nan))
            continue
        run = simulate(other.started(start, "2", (0.0, float(end.times[-1]))), EXACT)
        rows.append(
            np.array([end.times[-1], *_extremes(run.at, float(end.times[-1])), start[0], *end.after[:3, 0]])
        )
    table = np.array(rows)
    return Bifurcation(np.array(values), table[:, 0], table[:, 1], table[:, 2], table[:, 3:])


@dataclass(frozen=True, eq=False)
class Basins:
    """Where motions go: labels (4, n_slip, n_torque) index `OUTCOMES`; one layer a starting state of the machine.

    A cell that an interrupted run has not come to holds -1.
    """

    slip: Array
    torque: Array
    labels: NDArray[np.int8]

    def shares(self) -> dict[str, dict[str, float]]:
        """Share of each outcome for each starting state."""
        return {
            f"{q}": {name: float(np.mean(self.labels[q] == k)) for k, name in enumerate(OUTCOMES)}
            for q in range(4)
        }


def basins(
    scene: HybridScene, slip: ArrayLike, torque: ArrayLike, progress: Callable[[int], None] | None = None
) -> Basins:
    """Outcome of the motion from every slip, torque and state of the machine.

    Raises
    ------
    StudyInterrupted   a KeyboardInterrupt; carries the `Basins` so far
    """
    s, T = checks.vector("slip", slip), checks.vector("torque", torque)
    corner(scene)
    follow = Follower(scene, FAST, SETTLED, SWITCHES)
    result = Basins(np.array(s), np.array(T), np.full((4, len(s), len(T)), -1, dtype=np.int8))
    try:
        for q in range(4):
            for i, x in enumerate(s):
                result.labels[q, i] = [classify(scene, follow([x, y], f"{q}")) for y in T]
                if progress is not None:
                    progress(q * len(s) + i + 1)
    except KeyboardInterrupt:
        raise StudyInterrupted(result) from None
    return result


@dataclass(frozen=True)
class Margin:
    """How far the slip may be off as a state is entered, downwards and upwards, with the cycle kept; None: any."""

    state: str
    slip: float
    down: float | None
    up: float | None


def margins(scene: HybridScene, cycle: Cycle, width: float = 1e-9) -> list[Margin]:
    """The error allowed in the slip at each switch of the cycle: distances to the edges of the basin there."""
    follow, result = Follower(scene, FAST, SETTLED, SWITCHES), []

    for state, slip, torque in zip(cycle.states, cycle.slip, cycle.torque, strict=True):

        def good(x: float, state: str = state, torque: float = float(torque)) -> bool:
            return classify(scene, follow([x, torque], state)) == CYCLE

        slip = float(slip)
        down, up = (_first_edge(good, slip, end, width) for end in (0.0, 1.0))
        result.append(
            Margin(state, slip, None if down is None else slip - down, None if up is None else up - slip)
        )
    return result


def _first_edge(good: Callable[[float], bool], start: float, end: float, width: float) -> float | None:
    """The edge of the basin nearest to the start, looked for in steps, then by bisection."""
    inside = start
    for x in np.linspace(start, end, 101)[1:]:
        if not good(float(x)):
            return edge(good, inside, float(x), width)
        inside = float(x)
    return None


def allowed_bias(scene: HybridScene, quantity: str, width: float = 1e-9) -> tuple[float | None, float | None]:
    """Constant errors e between which the cycle persists when `quantity` is measured as its value plus e.

    Parameters
    ----------
    quantity : "slip" or "torque", whose two thresholds act at their values minus e

    Returns
    -------
    lowest and highest error; None where none ends the cycle down to lambda_max - e = 1 or twice T_max, and up to a
        lower threshold of zero
    """
    if quantity not in ("slip", "torque"):
        raise ValueError(f"quantity: expected slip or torque, got {quantity!r}")
    low, high = (float(scene.parameters[f"{quantity}_{end}"]) for end in ("min", "max"))

    def good(e: float) -> bool:
        names = {f"{quantity}_min": low - e, f"{quantity}_max": high - e}
        return has_cycle(with_thresholds(scene, **names))

    lowest = high - 1.0 if quantity == "slip" else -high
    return _first_edge(good, 0.0, lowest, width), _first_edge(good, 0.0, low, width)


def stopping(run: HybridTrajectory) -> dict[str, Any]:
    """How a stop of the full model went: its end, time [s], distance [m], last speed [m/s], and every switch.

    `locked` is the time [s] at which the wheel locks first, or None.
    """
    stands = [float(s.time) for s in run.switches if s.target == "standing"]
    locked = [float(s.time) for s in run.switches if s.target.endswith("locked")]
    end = stands[0] if stands else float(run.t[-1])
    nodes, weights = np.polynomial.legendre.leggauss(6)
    distance = 0.0
    for a, b in pairwise(run.pieces.t[run.pieces.t <= end]):
        distance += 0.5 * (b - a) * float(weights @ run.at(0.5 * (a + b) + 0.5 * (b - a) * nodes)[:, 2])
    return {
        "parameters": dict(run.scene.parameters),
        "end": "stands" if stands else f"still in state {run.mode[-1]}",
        "time": end,
        "distance": distance,
        "speed": float(run.x[-1, 2]),
        "locked": locked[0] if locked else None,
        "switches": [
            {"time": float(s.time), "state": str(s.target), "slip": float(s.after[0]), "torque": float(s.after[1]),
             "speed": float(s.after[2])} for s in run.switches
        ],
    }  # fmt: skip
