"""The Moreau theta-method: its parameters, and what scenes it takes.

The run itself: `moreau_run`; its kernels: `theta_method`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from lagrangian import LinearContacts, LinearSystem, Scene, checks
from lcpstep.refusals import refused
from lcpstep.stepping.steps import check_steps

if TYPE_CHECKING:
    from lcpstep.recording import Kept
    from lcpstep.stepping.sparse.steps import SparseRun
    from lcpstep.trajectory import Trajectory


@dataclass(frozen=True)
class Moreau:
    """Moreau's time-stepping with the theta-method.

    Parameters
    ----------
    h : step [s]; the last step is shortened where h does not divide the span. With a tolerance: the longest step
    theta : 0 explicit, 1/2 trapezoidal (keeps the energy of linear systems), 1 implicit; below 1/2 oscillations grow
    lcp : solver of the complementarity problems, "lemke" (compiled with the loop) or any name that
        `lcpstep.solve_lcp` takes: "qp", "qp:daqp", ...; joints, friction and projection take "lemke" only
    projected : put positions back onto joints and out of obstacles at the end of every step
    tolerance : None for steps of h; else steps are h or shorter, and errors of positions and velocities are kept near
        tolerance * (1 + size of the motion) over the span, in the scene's units. Steps are short where something
        strikes; contacts that close slower than the tolerance resolves do not rebound. Takes "lemke" and dense steps
        only; a tolerance that cannot be met ends the run with the status STEP_TOO_SMALL

    Raises
    ------
    TypeError   projected is neither True nor False
    ValueError   h or the tolerance is not positive, theta lies outside [0, 1], or the solver's name is unknown
    LcpStepError   a tolerance is given with another solver than "lemke"
    MissingSolver   the solver is not installed

    Notes
    -----
    A contact is active in a step where g + (h/2) u <= 0 at its start. One that separates has no part in the blow of
    another; what a blow makes approach again is struck next, in the same step (`theta_method.blows`). Contacts that
    approach in one step strike at once, whichever would close first. Order one in the presence of impacts, whatever
    theta: an impact is moved to the end of its step. Linear scenes with sparse matrices of more than 100 coordinates
    or contacts (200 with joints or friction) run without a dense one, by their own solver (`lcpstep.lcp.saddle`).
    """

    h: float = 1e-4
    theta: float = 0.5
    lcp: str = "lemke"
    projected: bool = False
    tolerance: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "h", checks.positive("h", self.h))
        object.__setattr__(self, "theta", checks.number("theta", self.theta, least=0.0, most=1.0))
        if self.lcp != "lemke":
            from lcpstep.lcp import check_method

            check_method(self.lcp)
        checks.instance("projected", self.projected, bool)
        if self.tolerance is not None:
            object.__setattr__(self, "tolerance", checks.positive("tolerance", self.tolerance))
            if self.lcp != "lemke":
                raise refused("solver-tolerance")

    def beyond_contacts(self, scene: Scene) -> bool:
        """Whether the scene's steps have more in them than frictionless contacts."""
        frictional = scene.contacts is not None and scene.contacts.friction is not None
        return scene.n_j > 0 or frictional or self.projected

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene; see `lcpstep.simulate`."""
        check_steps(self.h, scene.t_span, longest=self.tolerance is not None)
        if self.lcp != "lemke" and self.beyond_contacts(scene):
            raise refused("solver-beyond-contacts", scene)
        if is_sparse(scene):
            sparse_run = self.by_sparse_steps(scene)
            if sparse_run is not None:
                return sparse_run(self, scene, kept).finish(progress)
        from lcpstep.stepping.moreau_run import MoreauRun

        return MoreauRun(self, scene, kept).finish(progress)

    def by_sparse_steps(self, scene: Scene) -> type[SparseRun] | None:
        """The run by sparse steps, where they know all that is asked for; None where dense steps take the scene.

        Dense steps take few coordinates too, unless a sparse solver is asked for by name.

        Raises LcpStepError where it is too large for those.
        """
        from lcpstep.model import LARGEST_DENSE
        from lcpstep.stepping.sparse import coupled, steps

        unknown, beyond = "", self.beyond_contacts(scene)
        if self.tolerance is not None:
            unknown = "sparse-tolerance"
        elif self.lcp not in steps.SOLVERS:
            unknown = "sparse-solver"
        elif self.projected:
            unknown = "sparse-projected"
        elif beyond:
            unknown = coupled.unknown(scene)
        if unknown and scene.n_q > LARGEST_DENSE:
            raise refused(unknown, scene)
        most = coupled.FEW if beyond else steps.FEW
        few = self.lcp == "lemke" and max(scene.n_q, scene.n_c) <= most
        if unknown or few:
            return None
        return coupled.CoupledRun if beyond else steps.SparseRun


def is_sparse(scene: Scene) -> bool:
    """Whether the scene asks for sparse steps: a linear system and contacts, one of them with a sparse matrix."""
    system, contacts = scene.system, scene.contacts
    if not isinstance(system, LinearSystem) or not (contacts is None or isinstance(contacts, LinearContacts)):
        return False
    return system.sparse or (contacts is not None and contacts.sparse)
