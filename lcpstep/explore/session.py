"""What one visitor of the page looks at: a scene with parameters, a start, a method; and the run that they give."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep import EventDriven, Located, Moreau, simulate
from lcpstep.analysis.basins import basins
from lcpstep.errors import LcpStepError, SimulationError, SimulationInterrupted
from lcpstep.explore import views
from lcpstep.simulation import Method
from lcpstep.trajectory import Trajectory

METHODS: dict[str, Callable[[float], Method]] = {
    "located": Located,
    "event-driven": lambda h: EventDriven(rtol=1e-9, atol=1e-9),
    "moreau": Moreau,
}
STEPS = 2000  # of a span
PATIENCE = 2.0  # for a run; what there is of the motion then is shown [s]
CELLS, LONGEST, SAMPLE = (
    200,
    1000,
    500,
)  # of a basin: cells a side, periods to wait, cells followed one by one


@dataclass
class Session:
    """One visitor.

    Parameters
    ----------
    make : function of parameters by name, and of the span's end (None: the scene's own) that gives a scene
    values : parameters that differ from the scene's own
    """

    make: Callable[[Mapping[str, Any], float | None], Scene]
    values: dict[str, Any] = field(default_factory=dict)
    t_end: float | None = None
    method: str = "located"
    start: tuple[float, float] | None = None  # of the first coordinate; None: the scene's own
    message: str = ""

    def scene(self) -> Scene:
        """The scene as it is set."""
        scene = self.make(self.values, self.t_end)
        if self.start is None:
            return scene
        q, v = np.array(scene.q0), np.array(scene.v0)
        q[0], v[0] = self.start
        return replace(scene, q0=q, v0=v)

    def run(self) -> Trajectory | None:
        """The motion, as far as it is computed within `PATIENCE`; None where it cannot begin: `message` says why."""
        begun, late = time.perf_counter(), False

        def progress(t: float) -> None:
            nonlocal late
            if time.perf_counter() - begun > PATIENCE:
                late = True
                raise KeyboardInterrupt

        try:
            scene = self.scene()
            method = METHODS[self.method]((scene.t_span[1] - scene.t_span[0]) / STEPS)
            run: Trajectory = simulate(scene, method, progress=progress)
        except SimulationInterrupted as stopped:
            if not late:
                raise
            run = stopped.trajectory
            self.message = (
                f"stopped after {PATIENCE:g} s of computing, at t = {run.t[-1]:.4g} s: a shorter span?"
            )
            return run
        except SimulationError as error:
            self.message = str(error)
            return error.trajectory
        except (LcpStepError, ValueError, ArithmeticError) as error:
            self.message = str(error)
            return None
        used = time.perf_counter() - begun
        self.message = f"{run.message}; {len(views.impacts(run))} impacts, {used * 1e3:.0f} ms"
        return run

    def basin(self, low: Any, high: Any, progress: Callable[[int, int], None] | None = None) -> Any:
        """Basins of attraction over a rectangle of starts; a dataset of `lcpstep.analysis.basins`."""
        scene = self.make(self.values, None)
        return basins(
            scene, low, high, (CELLS, CELLS), method=EventDriven(), longest=LONGEST, sample=SAMPLE, progress=progress
        )  # fmt: skip


def slider_range(value: float) -> tuple[float, float, float]:
    """Lowest and highest value and step of the slider of a parameter, from its own value."""
    if isinstance(value, int):
        return min(1, value), max(2 * value, 5), 1
    low, high = (0.0, 1.0) if 0.0 < value < 1.0 else (min(2.0 * value, 0.0), max(2.0 * value, 0.0))
    if low == high:
        low, high = -1.0, 1.0
    return low, high, (high - low) / 200.0


def sliding(parameters: Mapping[str, Any]) -> dict[str, float]:
    """The parameters that a slider moves: numbers."""
    return {
        name: x for name, x in parameters.items() if isinstance(x, (int, float)) and not isinstance(x, bool)
    }
