"""The event-driven method: its parameters, and which kind of run a scene asks for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lagrangian import HybridScene, LinearSystem, Scene, checks

if TYPE_CHECKING:
    from lcpstep.events.hybrid.trajectory import HybridTrajectory
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
    audit : whether the finished run is searched for events that it has not noticed, see `lcpstep.audit`; those that
        are found are taken, and `Trajectory.audit` says what could be shown
    jamming : "stop" or "impact"   what follows where no force keeps a sliding contact on its surface (Painleve): the
        run ends with PAINLEVE_INCONSISTENT, or an impact without collision ends the sliding; `Kind.JAM` in the log

    Raises
    ------
    TypeError   audit is neither True nor False
    ValueError   a tolerance or the bound is out of range, or jamming is neither of the two

    Notes
    -----
    One linear degree of freedom with one contact at most, under constant and harmonic forces moves in closed form
    between events, and so do a body that a constant force presses on a floor or belt with constant coefficients of
    friction, and a system without friction under constant forces with flat contacts at rest; all others by DOP853.

    What the tolerances control is the error of each step, at its end and in between. Positions at any time were at
    most six times atol + rtol |q| off on the catalogue's motions, from 1e-4 to 1e-12 (docs/accuracy.md); where the
    motion itself separates neighbours by a factor, errors made before grow by that factor as well.

    Several contacts: those that are closed at one time strike in one problem, 0 <= u+ + r u- complementary to
    p >= 0 (Newton's law in Moreau's form), whether they have rested until then or meet at the same instant; with
    joints, their impulses are part of it. Impacts at different times follow one another, however near. So balls of
    a cradle that touch share the blow, and balls a thousandth of a micrometre apart hand it on. Where the motion is
    known exactly, gaps that differ by rounding close at the same instant unless the order of their impacts makes no
    difference (elastic beads of one mass); at the start of an integrated motion a gap below the tolerance counts as
    closed. This law is solvable for any contacts and loses energy for any restitutions, while the outcome of impacts
    in turn depends on an order that nothing but a gap can tell.

    Joints that depend on others are left out, and the others carry what all would; contacts that do so share their
    forces in one of the possible ways. Joints and lasting contacts are put back onto g = 0, u = 0 after each step,
    and states kept at given times are put there.
    """

    rtol: float = 1e-12
    atol: float = 1e-12
    max_events: int = 10_000_000
    audit: bool = field(default=False, repr=False)
    jamming: str = field(default="stop", repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "rtol", checks.number("rtol", self.rtol, least=LEAST_TOLERANCE, most=1.0))
        object.__setattr__(self, "atol", checks.positive("atol", self.atol))
        object.__setattr__(self, "max_events", checks.limit("max_events", self.max_events))
        checks.instance("audit", self.audit, bool)
        if not isinstance(self.jamming, str) or self.jamming not in ("stop", "impact"):
            raise ValueError(f'jamming: expected "stop" or "impact", got {self.jamming!r}')

    def run_hybrid(
        self, scene: HybridScene, kept: Kept, progress: Callable[[float], None]
    ) -> HybridTrajectory:
        """The motion of a system with modes; see `lcpstep.simulate`."""
        if scene.contacts is not None:
            from lcpstep.events.contacts.with_modes import RunWithModes

            return RunWithModes(self, scene, kept).finish(progress)
        from lcpstep.events.hybrid.run import HybridRun

        return HybridRun(self, scene, kept).finish(progress)

    def run(self, scene: Scene, kept: Kept, progress: Callable[[float], None]) -> Trajectory:
        """The motion of a scene; see `lcpstep.simulate`."""
        from lcpstep.model import joint_model, model

        if scene.contacts is not None and scene.contacts.friction is not None:
            from lcpstep.events.arcs.line import line_of

            line = line_of(scene)
            if line is not None:
                from lcpstep.events.arcs.run import ArcRun

                return ArcRun(self, scene, kept, line).finish(progress)
        elif isinstance(scene.system, LinearSystem):
            m = model(scene)
            if scene.n_q == 1 and scene.n_c <= 1 and scene.n_j == 0:
                from lcpstep.events.flight.oscillator import is_lost, oscillator_of
                from lcpstep.events.flight.run import ClosedForm

                o = oscillator_of(m)
                if o is not None and not is_lost(o, m, *scene.t_span):
                    return ClosedForm(self, scene, kept, m, o).finish(progress)
            from lcpstep.events.parabolas.run import ParabolicRun, is_constant

            joints = joint_model(scene) if scene.n_j > 0 else m
            if is_constant(m, joints):
                return ParabolicRun(self, scene, kept, m, joints).finish(progress)
        from lcpstep.events.contacts.run import ContactRun

        return ContactRun(self, scene, kept).finish(progress)
