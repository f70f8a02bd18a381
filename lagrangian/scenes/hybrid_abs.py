"""A hybrid anti-lock braking controller on a quarter car: four states of a machine switch the brake torque.

    mu(lambda) = th1 (1 - exp(-th2 lambda)) - th3 lambda                   friction of the road [Osorio 7.4]
    lambda' = -(1 - lambda)/(J omega) (Psi(lambda) - T_b),   T_b' = u      slip and brake torque [Osorio 7.7-7.8]
    Psi(lambda) = (r + J (1 - lambda)/(r m)) F_z mu(lambda)                torque that holds the slip [Osorio 7.9]

The machine raises the torque in state 0 up to T_max, holds it in 1 until lambda_max, lowers it in 2 to T_min, and
holds it in 3 until lambda_min. Three models:

- "slip": the speed v is given, omega = v (1 - lambda)/r follows from the slip: lambda' = -(r/(J v)) (Psi - T_b).
  The wheel locks in finite time. The torque of the brake turns its sign with omega, so lambda = 1 is a switching
  surface; a locked wheel slides on it.
- "constant": omega stays at v/r in the equation above; lambda = 1 is approached, not reached.
- "full": v is a state, v' = -F_z mu/m, and omega = v (1 - lambda)/r; the car stands from a lowest speed on.

Source: G. Osorio, Complex Behavior in Impacting Systems, chapter 7; M. Tanelli, G. Osorio, M. di Bernardo,
S. Savaresi, A. Astolfi, Existence, stability and robustness analysis of limit cycles in hybrid anti-lock braking
systems, International Journal of Control 82 (2009).
"""

from __future__ import annotations

import math
from typing import Any

from lagrangian import checks
from lagrangian.hybrid import HybridScene, HybridSystem
from lagrangian.modes import Guard, Mode, Surface
from lagrangian.scenes.catalogue import checked

ROADS = {"dry": (1.11, 23.99, 0.52), "wet": (0.687, 33.822, 0.347)}  # th1, th2, th3 [Osorio 7.5-7.6]
MODELS = ("slip", "constant", "full")
SLOWEST = 1.0  # speed at which the full model stands [m/s]
# Places in the parameters p
TH1, TH2, TH3, INERTIA, MASS, RADIUS, GRAVITY, SPEED, RATE, T_MAX, T_MIN, SLIP_MAX, SLIP_MIN = range(13)
SLIP, TORQUE, CAR_SPEED = range(3)  # places in the state
LABELS = ("slip [-]", "brake torque [N m]", "speed [m/s]")


def friction(slip: float, p: Any) -> float:
    """mu(lambda); odd about lambda = 0, where the wheel is driven."""
    s = abs(slip)
    mu = p[TH1] * (1.0 - math.exp(-s * p[TH2])) - s * p[TH3]
    return math.copysign(mu, slip)


def holding_torque(slip: float, p: Any) -> float:
    """Psi(lambda): the brake torque at which the slip stays [N m]."""
    arm = p[RADIUS] + p[INERTIA] * (1.0 - slip) / (p[RADIUS] * p[MASS])
    return arm * p[MASS] * p[GRAVITY] * friction(slip, p)


def holding_torque_slope(slip: float, p: Any) -> float:
    """dPsi/dlambda, for a slip that is not negative [N m]."""
    arm = p[RADIUS] + p[INERTIA] * (1.0 - slip) / (p[RADIUS] * p[MASS])
    steeper = p[TH1] * p[TH2] * math.exp(-slip * p[TH2]) - p[TH3]
    return p[MASS] * p[GRAVITY] * (arm * steeper - p[INERTIA] / (p[RADIUS] * p[MASS]) * friction(slip, p))


def _reduced(x: Any, p: Any, u: float, turning: float, out: Any) -> None:
    out[0] = -p[RADIUS] / (p[INERTIA] * p[SPEED]) * (holding_torque(x[0], p) - turning * x[1])
    out[1] = u


def _constant(x: Any, p: Any, u: float, out: Any) -> None:
    rate = (1.0 - x[0]) * p[RADIUS] / (p[INERTIA] * p[SPEED])
    out[0], out[1] = -rate * (holding_torque(x[0], p) - x[1]), u


def _full(x: Any, p: Any, u: float, turning: float, out: Any) -> None:
    out[0] = -p[RADIUS] / (p[INERTIA] * x[2]) * (holding_torque(x[0], p) - turning * x[1])
    out[1] = u
    out[2] = -p[GRAVITY] * friction(x[0], p)


def _raise(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, p[RATE], 1.0, out)


def _hold(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, 0.0, 1.0, out)


def _lower(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, -p[RATE], 1.0, out)


def _raise_back(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, p[RATE], -1.0, out)


def _hold_back(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, 0.0, -1.0, out)


def _lower_back(t: float, x: Any, p: Any, out: Any) -> None:
    _reduced(x, p, -p[RATE], -1.0, out)


def _raise_constant(t: float, x: Any, p: Any, out: Any) -> None:
    _constant(x, p, p[RATE], out)


def _hold_constant(t: float, x: Any, p: Any, out: Any) -> None:
    _constant(x, p, 0.0, out)


def _lower_constant(t: float, x: Any, p: Any, out: Any) -> None:
    _constant(x, p, -p[RATE], out)


def _raise_full(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, p[RATE], 1.0, out)


def _hold_full(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, 0.0, 1.0, out)


def _lower_full(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, -p[RATE], 1.0, out)


def _raise_full_back(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, p[RATE], -1.0, out)


def _hold_full_back(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, 0.0, -1.0, out)


def _lower_full_back(t: float, x: Any, p: Any, out: Any) -> None:
    _full(x, p, -p[RATE], -1.0, out)


def _stand(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = out[1] = out[2] = 0.0


FIELDS = {
    "slip": ((_raise, _hold, _lower, _hold), (_raise_back, _hold_back, _lower_back, _hold_back)),
    "constant": ((_raise_constant, _hold_constant, _lower_constant, _hold_constant), ()),
    "full": (
        (_raise_full, _hold_full, _lower_full, _hold_full),
        (_raise_full_back, _hold_full_back, _lower_full_back, _hold_full_back),
    ),
}


def _torque_high(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[1] - p[T_MAX]


def _slip_high(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[0] - p[SLIP_MAX]


def _torque_low(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = p[T_MIN] - x[1]


def _slip_low(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = p[SLIP_MIN] - x[0]


def _locking(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = x[0] - 1.0


def _standing(t: float, x: Any, p: Any, out: Any) -> None:
    out[0] = SLOWEST - x[2]


GUARDS = (_torque_high, _slip_high, _torque_low, _slip_low)


def machine(model: str, crossing: bool) -> HybridSystem:
    """The four states "0" .. "3", with "q back" and "q locked" where the wheel can lock, and "standing"."""
    fields, backwards = FIELDS[model]
    end = [Guard(_standing, "standing")] if model == "full" else []
    modes, surfaces = {}, []
    for q, (field, guard) in enumerate(zip(fields, GUARDS, strict=True)):
        following = (q + 1) % 4
        modes[f"{q}"] = Mode(field, [Guard(guard, f"{following}", at_once=not crossing), *end])
        if backwards:
            modes[f"{q} back"] = Mode(
                backwards[q], [Guard(guard, f"{following} back", at_once=not crossing), *end]
            )
            locked = [Guard(guard, f"{following} locked", at_once=not crossing), *end]
            surfaces.append(Surface(_locking, f"{q}", f"{q} back", f"{q} locked", locked))
    if end:
        modes["standing"] = Mode(_stand)
    return HybridSystem(3 if model == "full" else 2, modes, surfaces)


@checked
def hybrid_abs(
    road: str = "dry",
    model: str = "slip",
    torque_max: float = 1600.0,
    torque_min: float = 1000.0,
    slip_max: float = 0.35,
    slip_min: float = 0.08,
    rate: float = 10_000.0,
    speed: float = 30.0,
    slip: float = 0.08,
    torque: float = 1000.0,
    state: int = 0,
    t_end: float = 2.0,
    crossing: bool = False,
) -> HybridScene:
    """Quarter car with a hybrid anti-lock controller; x = (slip, brake torque [N m]), in the full model (..., speed).

    Parameters
    ----------
    road : "dry" or "wet"
    model : "slip", "constant" or "full", see the module
    torque_max, torque_min, slip_max, slip_min : thresholds of the machine [N m], [-]
    rate : at which the torque is raised and lowered [N m/s]
    speed : of the car [m/s]; at the start, in the full model
    slip, torque, state : at the start; state of the machine 0 .. 3
    crossing : False: a state is left as soon as its quantity lies beyond the threshold, also where it did from the
        start. True: only where the quantity passes through the threshold.

    Raises
    ------
    ValueError   a name is unknown, or thresholds are not in order
    """
    if road not in ROADS:
        raise ValueError(f"road: expected one of {', '.join(ROADS)}, got {road!r}")
    if model not in MODELS:
        raise ValueError(f"model: expected one of {', '.join(MODELS)}, got {model!r}")
    for name, x in (("rate", rate), ("speed", speed), ("t_end", t_end), ("torque_max", torque_max)):
        checks.positive(name, x)
    checks.number("torque_min", torque_min, least=0.0)
    if not torque_min < torque_max:
        raise ValueError(f"torque_min: expected less than torque_max = {torque_max:g}, got {torque_min!r}")
    checks.number("slip_max", slip_max, least=0.0, most=1.0)
    checks.number("slip_min", slip_min, least=0.0)
    if not slip_min < slip_max:
        raise ValueError(f"slip_min: expected less than slip_max = {slip_max:g}, got {slip_min!r}")
    checks.number("slip", slip, least=0.0, most=1.0)
    checks.number("torque", torque, least=0.0)
    if state not in range(4):
        raise ValueError(f"state: expected 0, 1, 2 or 3, got {state!r}")
    th1, th2, th3 = ROADS[road]
    numbers = {
        "th1": th1, "th2": th2, "th3": th3, "inertia": 1.0, "mass": 400.0, "radius": 0.3, "g": 9.81, "speed": speed,
        "rate": rate, "torque_max": torque_max, "torque_min": torque_min, "slip_max": slip_max, "slip_min": slip_min,
    }  # fmt: skip
    return HybridScene(
        machine(model, crossing),
        [slip, torque, speed] if model == "full" else [slip, torque],
        f"{state}",
        (0.0, t_end),
        p=list(numbers.values()),
        parameters=numbers | {"road": road, "model": model},
        name="hybrid-abs",
        labels=LABELS[: 3 if model == "full" else 2],
    )
