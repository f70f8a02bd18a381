"""The limit cycle of the hybrid anti-lock controller: switching states, multiplier; what other motions end in.

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
from numpy.typing import NDArray

from lagrangian import checks
from lagrangian.hybrid import HybridScene
from lagrangian.scenes.hybrid_abs import SLIP_MAX, T_MAX, holding_torque, holding_torque_slope
from lcpstep.analysis.hybrid_variation import monodromy
from lcpstep.errors import LcpStepError
from lcpstep.events import EventDriven
from lcpstep.events.hybrid.many import End, Follower
from lcpstep.events.hybrid.trajectory import HybridTrajectory
from lcpstep.kernels.gauss import gauss
from lcpstep.simulation import simulate
from lcpstep.trajectory import Status

Array = NDArray[np.float64]
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
    checks.instance("scene", scene, HybridScene)
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
    lowest, highest = extremes(run.at, period)
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


def extremes(at: Callable[[Any], Array], period: float) -> tuple[float, float]:
    """Smallest and largest value of the first coordinate over a period."""
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


def stopping(run: HybridTrajectory) -> dict[str, Any]:
    """How a stop of the full model went: its end, time [s], distance [m], last speed [m/s], and every switch.

    `locked` is the time [s] at which the wheel locks first, or None.
    """
    stands = [float(s.time) for s in run.switches if s.target == "standing"]
    locked = [float(s.time) for s in run.switches if s.target.endswith("locked")]
    end = stands[0] if stands else float(run.t[-1])
    nodes, weights = gauss(6)
    distance = 0.0
    for a, b in pairwise(run.pieces.t[run.pieces.t <= end]):
        distance += (b - a) * float(weights @ run.at(a + (b - a) * nodes)[:, 2])
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
