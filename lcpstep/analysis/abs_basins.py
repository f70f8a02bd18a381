"""Where motions of the hybrid anti-lock controller go, and what errors of measurement its cycle stands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lagrangian import checks
from lagrangian.hybrid import HybridScene
from lcpstep.analysis.abs_cycle import (
    CYCLE,
    FAST,
    OUTCOMES,
    SETTLED,
    SWITCHES,
    Cycle,
    classify,
    corner,
)
from lcpstep.analysis.abs_parameters import edge, has_cycle, with_thresholds
from lcpstep.errors import StudyInterrupted
from lcpstep.events.hybrid.many import Follower

Array = NDArray[np.float64]


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
    checks.instance("scene", scene, HybridScene)
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
