"""Simulation of Lagrangian systems with unilateral constraints.

Time-stepping by complementarity problems (`Moreau`, `Located`) and event by event (`EventDriven`), on scenes made
with the package `lagrangian`; and `solve_lcp`, the solver underneath. Importing this loads nothing yet: every name is
imported from its module when it is first asked for.
"""

from typing import TYPE_CHECKING

from lagrangian.lazy import lazily

if TYPE_CHECKING:
    from lcpstep.accuracy.study import study
    from lcpstep.continuing import continued
    from lcpstep.diagnostics import Energy, energy
    from lcpstep.errors import (
        LcpStepError,
        MissingSolver,
        SimulationError,
        SimulationInterrupted,
        UnknownName,
    )
    from lcpstep.events import EventDriven
    from lcpstep.lcp import solve_lcp
    from lcpstep.saving import load
    from lcpstep.simulation import simulate
    from lcpstep.stepping.located import Located
    from lcpstep.stepping.moreau import Moreau
    from lcpstep.trajectory import Kind, Status, Trajectory
else:
    __getattr__ = lazily(
        globals(),
        {
            "lcpstep.continuing": "continued",
            "lcpstep.diagnostics": "Energy energy",
            "lcpstep.errors": "LcpStepError MissingSolver SimulationError SimulationInterrupted UnknownName",
            "lcpstep.events": "EventDriven",
            "lcpstep.lcp": "solve_lcp",
            "lcpstep.saving": "load",
            "lcpstep.simulation": "simulate",
            "lcpstep.stepping.located": "Located",
            "lcpstep.stepping.moreau": "Moreau",
            "lcpstep.accuracy.study": "study",
            "lcpstep.trajectory": "Kind Status Trajectory",
        },
    )

__version__ = "0.2.0"
__all__ = [
    "Energy",
    "EventDriven",
    "Kind",
    "LcpStepError",
    "Located",
    "MissingSolver",
    "Moreau",
    "SimulationError",
    "SimulationInterrupted",
    "Status",
    "Trajectory",
    "UnknownName",
    "continued",
    "energy",
    "load",
    "simulate",
    "solve_lcp",
    "study",
]


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
