"""The event-driven method: its parameters, and which kind of run a scene asks for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from lagrangian import Scene, checks
from lcpstep.errors import LcpStepError
from lcpstep.events.closed_form import ClosedForm, oscillator_of
from lcpstep.events.runge_kutta import RungeKutta
from lcpstep.model import model, require
from lcpstep.recording import Kept
from lcpstep.trajectory import Trajectory

LEAST_TOLERANCE = 1e-14  # relative; below it rounding decides


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
        m, fast = model(scene)
        o = oscillator_of(scene, m)
        if o is not None:
            return ClosedForm(self, scene, kept, m, fast, o).finish(progress)
        return RungeKutta(self, scene, kept, m, fast).finish(progress)
