"""Time-stepping with every impulse at its own time within the step: its parameters; runs: `pieces`, `rubbing`."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, checks
from lcpstep.refusals import refused
from lcpstep.stepping.steps import check_steps

if TYPE_CHECKING:
    from lcpstep.recording import Kept
    from lcpstep.trajectory import Trajectory

ORDERS = (2, 4, "exact")


@dataclass(frozen=True)
class Located:
    """Time-stepping that places every impact at its own time within the step.

    Parameters
    ----------
    h : step [s]; the last step is shortened where h does not divide the span
    order : 2, 4 or "exact", of the smooth motion and with it of the whole
        4: Runge-Kutta, five force evaluations a step and after every impact, thirteen while a contact rests; with
        friction or joints four. "exact": Taylor polynomials up to rounding, for linear systems under constant and
        harmonic forces (`lagrangian.Harmonic`) with flat contacts; a moving obstacle or frame with one coordinate
        only.
    max_events : bound on the number of events of a run, rounds of its loop without one included; it ends with the
        status TOO_MANY_EVENTS there
    max_per_step : bound on the events within one step; beyond it one plastic impact of all contacts ends the step,
        which loses energy that elastic contacts would keep; the run's message says how many steps that were. Not
        with friction or joints, where steps hold any number of events
    tolerance : None for steps of h; else steps are h or shorter, and errors of positions and velocities are kept near
        tolerance * (1 + size of the motion) over the span, in the scene's units. A tolerance that cannot be met ends
        the run with the status STEP_TOO_SMALL
    audit : whether the finished run is searched for events that it has not noticed, see `lcpstep.audit`; those that
        are found are taken, and `Trajectory.audit` says what could be shown

    Raises
    ------
    TypeError   audit is neither True nor False
    ValueError   h, a bound or the tolerance is not positive, the order is none of these, or a tolerance is given with
        order "exact"
    LcpStepError   when it runs: with order "exact" the scene has friction or joints, or not the linear motion under
        constant and harmonic forces that it takes

    Notes
    -----
    Smooth motion is of order two, with one force evaluation a step; so is the whole motion, through impacts,
    chattering, sticking and release. Contacts that fire together obey Moreau's law for simultaneous impacts, all
    others are struck one after another. Linear systems take the trapezoidal rule and are stable for every h, others
    velocity Verlet, which needs h below 2 / (highest frequency).

    With planar friction (`Coulomb`) or joints steps are velocity Verlet's or, of order 4, those of Runge-Kutta's
    classical method, along the modes of the contacts (`lcpstep.stepping.rubbing`); every step ends on the joints.
    Slips, sticks and reversals have their own times, as impacts have. Sources: J. J. Moreau (1988), V. Acary and
    B. Brogliato (2008) for the impact law; N. Newmark (1959) and H. Andersen (1983) for the motion between impacts
    and the joints.
    """

    h: float = 1e-3
    order: int | str = 2
    max_events: int = 10_000_000
    max_per_step: int = 10_000_000
    tolerance: float | None = None
    audit: bool = field(default=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "h", checks.positive("h", self.h))
        known = isinstance(self.order, Hashable) and self.order in ORDERS
        if not known or isinstance(self.order, (bool, float)):
            raise ValueError(f'order: expected 2, 4 or "exact", got {self.order!r}')
        object.__setattr__(self, "max_events", checks.limit("max_events", self.max_events))
        object.__setattr__(self, "max_per_step", checks.limit("max_per_step", self.max_per_step))
        checks.instance("audit", self.audit, bool)
        if self.tolerance is not None:
            object.__setattr__(self, "tolerance", checks.positive("tolerance", self.tolerance))
            if self.order == "exact":
                raise ValueError(str(refused("exact-tolerance")))

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene; see `lcpstep.simulate`."""
        check_steps(self.h, scene.t_span, longest=self.tolerance is not None)
        friction = scene.contacts is not None and scene.contacts.friction is not None
        if self.order == "exact":
            require_exact(scene)
        elif friction or scene.n_j > 0:
            from lcpstep.stepping.rubbing.run import RubbingRun

            return RubbingRun(self, scene, kept).finish(progress)
        from lcpstep.stepping.pieces.run import LocatedRun

        return LocatedRun(self, scene, kept).finish(progress)


def require_exact(scene: Scene) -> None:
    """Refuse a scene whose motion between impacts is not known in closed form."""
    s, c = scene.system, scene.contacts
    if scene.n_j > 0:
        raise refused("exact-joints", scene)
    if c is not None and c.friction is not None:
        raise refused("exact-friction", scene)
    if not (isinstance(s, LinearSystem) and isinstance(s.force, Harmonic)):
        raise refused("exact-forces", scene)
    if not (c is None or isinstance(c, LinearContacts)):
        raise refused("exact-curved", scene)
    if scene.n_q > 1 and (s.frame is not None or (c is not None and c.motion is not None)):
        raise refused("exact-moving", scene)
