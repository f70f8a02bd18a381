"""Simulation of Lagrangian systems with unilateral constraints.

Time-stepping by complementarity problems (`Moreau`) and event by event (`EventDriven`), on scenes made with the
package `lagrangian`; and `solve_lcp`, the solver underneath. Importing this loads numpy only.
"""

from lcpstep.continued import continued
from lcpstep.diagnostics import Energy, energy
from lcpstep.errors import LcpStepError, MissingSolver, SimulationError, SimulationInterrupted, UnknownName
from lcpstep.events import EventDriven
from lcpstep.lcp import solve_lcp
from lcpstep.saving import load
from lcpstep.simulate import simulate
from lcpstep.stepping.located import Located
from lcpstep.stepping.moreau import Moreau
from lcpstep.study import study
from lcpstep.trajectory import Kind, Status, Trajectory

__version__ = "0.1.0"
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
