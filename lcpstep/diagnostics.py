"""Energy balance of a motion, and an audit of what its contacts did with the energy.

    T + V (t) - T + V (0)  =  work of the forces + work of the obstacles - damping - impacts - friction + residual

    T = v^T M v / 2,    V = q^T K q / 2 - constant^T q  of a linear system, of a general one its `potential`
    an impulse p dissipates -p (u+ + u-)/2, and the obstacle that moves with s' does the work p s'

The work is summed along the kept states: for `Moreau` with the mean velocity of each step, which closes the balance
of theta = 1/2 to rounding; otherwise by Gauss' rule on the dense output. What is left, the residual, is the
dissipation or the gain of the method itself, and the error of the sum where not every state was kept or where a force
jumps between two of them. While a contact of an event-driven run stays closed the work of its obstacle is taken from
the balance itself.

The audit needs no law of impact: what the energy of a step gained beyond the work of forces and obstacles came from
the contacts, and none may create energy. Source: V. Acary, Energy conservation and dissipation properties of
time-integration methods for nonsmooth elastodynamics with contact, ZAMM 96 (2016) 585.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import Harmonic, LinearContacts, LinearSystem, Scene, checks
from lcpstep.kernels import states
from lcpstep.kernels.gauss import gauss
from lcpstep.model import model, tangent_model
from lcpstep.stepping.sparse.equations import Equations
from lcpstep.trajectory import Kind, Trajectory

Array = NDArray[np.float64]
NODES = 10  # of Gauss' rule between two kept states
UNLOGGED = 1e-9  # of the largest impulse: more than that beside the impacts is a force that lasts
STEP_FOR_DIFFERENCES = 1e-3  # of the mean distance of kept states
CREATED = 1e-9  # of the largest energy: a gain below it is rounding


@dataclass(frozen=True, eq=False)
class Energy:
    """Energy balance at the kept states; every attribute but `t` and the last has shape (n,) and is in joules.

    Attributes
    ----------
    t : times [s]
    kinetic, potential, total
        The potential is zero for a `System` that gives none: all its forces then count as work.
    work : done up to t by the forces without potential: external ones, of a moving frame; of a general
        system by all forces without potential, damping included
    damping : dissipated up to t by the damping matrix
    obstacles : work done up to t by obstacles that move
    impacts : dissipated up to t at contacts, on their normals: of time-stepping with every state kept that of
        every step, otherwise that of the events of the impact log
    friction : dissipated up to t by dry friction
    residual : total - total[0] - work - obstacles + damping + impacts + friction
    created : record array of time [s], energy [J]: steps in whose contacts energy was created, or in which belts, or
        joints that move, did work, which is not told apart
    """

    t: Array
    kinetic: Array
    potential: Array
    work: Array
    damping: Array
    obstacles: Array
    impacts: Array
    friction: Array
    created: Any

    @property
    def total(self) -> Array:
        """Kinetic and potential energy."""
        return self.kinetic + self.potential

    @property
    def residual(self) -> Array:
        """What the balance leaves unexplained."""
        given = self.work + self.obstacles - self.damping - self.impacts - self.friction
        return self.total - self.total[0] - given

    def __repr__(self) -> str:
        e = self.total
        ends = f"{e[0]:.6g} J -> {e[-1]:.6g} J, residual {self.residual[-1]:.2g} J, " if len(e) else ""
        return f"Energy({ends}{len(self.t)} states)"


def energy(trajectory: Trajectory) -> Energy:
    """Energy balance of a motion.

    Parameters
    ----------
    trajectory : Trajectory   best with every state kept (`keep=1`): work is summed along the kept states

    Returns
    -------
    Energy; its `created` is empty where no contact created energy and no belt did work

    Raises
    ------
    ValueError   no state of the run was kept, or the potential gives no number at one that was

    Examples
    --------
    >>> from lagrangian import scenes
    >>> from lcpstep import Moreau, energy, simulate
    >>> balance = energy(simulate(scenes.bouncing_ball(t_end=1.0), Moreau(h=1e-3)))
    >>> len(balance.created), bool(abs(balance.residual[-1]) < 1e-12)
    (0, True)
    """
    checks.instance("trajectory", trajectory, Trajectory)
    if len(trajectory.t) == 0:
        raise ValueError("trajectory: expected a run of which states are kept")
    scene, m = trajectory.scene, trajectory
    kinetic, potential = _states(scene, m.t, m.q, m.v)
    work, damping = _powers(m)
    if not isinstance(scene.system, LinearSystem):
        work = work + np.diff(potential)  # its forces include those with a potential
    obstacles, held = _obstacles(m)
    friction, impacts = _friction(m), _contacts(m)
    change = np.diff(kinetic + potential) - work + damping
    obstacles[held] = (change + impacts)[held]
    if m.friction_impulse.size and not hasattr(m.method, "theta"):
        # sliding velocities between kept states, and at impacts, are not those of the ends: what is lost is known
        friction = obstacles - change - impacts
    created = _created(m, change - obstacles, kinetic + np.abs(potential))
    summed = (_summed(x) for x in (work, damping, obstacles, impacts, friction))
    return Energy(m.t, kinetic, potential, *summed, created)  # type: ignore[call-arg]


def _summed(parts: Array) -> Array:
    return np.concatenate([[0.0], np.cumsum(parts)])


def _interval(m: Trajectory, times: Array) -> Any:
    """In which interval between kept states each time lies; the end belongs to it."""
    early = 1e-9 * float(np.min(np.diff(m.t)))
    return np.clip(np.searchsorted(m.t, times - early, side="left") - 1, 0, len(m.t) - 2)


def _binned(m: Trajectory, values: Array) -> Array:
    """Sums of values of the impact log over the intervals between kept states."""
    if len(m.t) < 2:
        return np.zeros(0)
    return np.asarray(
        np.bincount(_interval(m, m.impacts.time), weights=values, minlength=len(m.t) - 1), dtype=np.float64
    )


def _created(m: Trajectory, gained: Array, size: Array) -> Any:
    pressed = m.impulse[1:].any(axis=1) if m.scene.n_c else np.zeros(len(gained), dtype=bool)
    where = np.flatnonzero(pressed & (gained > CREATED * np.max(size, initial=0.0)))
    out = np.recarray(len(where), dtype=[("time", "f8"), ("energy", "f8")])
    out.time, out.energy = m.t[1:][where], gained[where]
    return out


def _states(scene: Scene, t: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """Kinetic and potential energy of states."""
    system: Any = scene.system
    if isinstance(system, LinearSystem):
        e = _equations(scene)
        kinetic = 0.5 * np.einsum("ij,ij->i", v, (e.M @ v.T).T)
        potential = 0.5 * np.einsum("ij,ij->i", q, (e.K @ q.T).T)
        return kinetic, potential - (q @ e.terms[0] if e.harmonic else 0.0)
    kinetic, _ = _system_rates(scene, t, q, v)
    potential = np.zeros(len(t))
    if system.potential is not None:
        potential.fill(np.nan)
        for k, at in enumerate(zip(t, q, v, [np.array(scene.p)] * len(t), strict=True)):
            system.potential(*at, potential[k : k + 1])
            if not isfinite(potential[k]):  # which says so
                checks.evaluate("system.potential", system.potential, at, (1,))
    return kinetic, potential


def _equations(scene: Scene) -> Equations:
    return Equations(replace(scene, contacts=None, joints=None, exact=None))


def _powers(m: Trajectory) -> tuple[Array, Array]:
    """Work of the forces and of the damping matrix between kept states, each (n - 1,)."""
    h = np.diff(m.t)
    if hasattr(m.method, "theta") or not _is_dense(m):
        means = [0.5 * (x[1:] + x[:-1]) for x in (m.t, m.q, m.v)]
        return _rates(m, means[0], means[1], means[2], h, ends=True)
    work, damping = np.zeros(len(h)), np.zeros(len(h))
    for node, weight in zip(*gauss(NODES), strict=True):
        t = m.t[:-1] + node * h
        parts = _rates(m, t, *m.at(t), weight * h, ends=False)
        work, damping = work + parts[0], damping + parts[1]
    return work, damping


def _is_dense(m: Trajectory) -> bool:
    try:
        m.at(0.5 * (m.t[:1] + m.t[1:2]))
    except ValueError:
        return False
    return len(m.t) > 1


def _rates(m: Trajectory, t: Array, q: Array, v: Array, h: Array, *, ends: bool) -> tuple[Array, Array]:
    """Power times h of the forces and of the damping; `ends`: forces of time as the mean of the intervals' ends."""
    scene = m.scene
    if not isinstance(scene.system, LinearSystem):
        _, power = _system_rates(scene, t, q, v)
        if ends:  # what the change of M(t, q) adds to the kinetic energy
            now, before = (
                _system_rates(scene, x, y, v)[0] for x, y in ((m.t[1:], m.q[1:]), (m.t[:-1], m.q[:-1]))
            )
            return h * power + (now - before), np.zeros(len(t))
        near = STEP_FOR_DIFFERENCES * np.diff(m.t).mean()
        now, before = (_system_rates(scene, t + d, q + d * v, v)[0] for d in (near, -near))
        return h * (power + (now - before) / (2.0 * near)), np.zeros(len(t))
    e = _equations(scene)
    F = _forces(e, m.t, m.q, m.v) if ends else _forces(e, t, q, v)
    F = 0.5 * (F[1:] + F[:-1]) if ends else F
    F = F - e.terms[0] if e.harmonic else F
    return h * np.einsum("ij,ij->i", v, F), h * np.einsum("ij,ij->i", v, (e.C @ v.T).T)


def _forces(e: Equations, t: Array, q: Array, v: Array) -> Array:
    if e.harmonic and not e.callbacks:
        angle = (e.harmonic.omega * t)[:, None]
        constant, cosine, sine = e.terms
        return constant + cosine * np.cos(angle) + sine * np.sin(angle)
    return np.array([e.force(t[k], q[k], v[k]) for k in range(len(t))]).reshape(q.shape)


def _system_rates(scene: Scene, t: Array, q: Array, v: Array) -> tuple[Array, Array]:
    """Kinetic energy, and the power v^T f of all forces but those of contacts, of a general system."""
    return states.power(model(scene), *map(np.ascontiguousarray, (t, q, v)))


def _obstacles(m: Trajectory) -> tuple[Array, Any]:
    """Work of moving obstacles and belts between kept states, -p g_t and -p_T slip, and where that is not known."""
    scene: Any = m.scene
    held: Any = np.zeros(len(m.t) - 1, dtype=bool)
    work = np.zeros(len(m.t) - 1)
    if scene.n_c == 0 or len(m.t) < 2:
        return work, held
    contacts = scene.contacts
    moving = contacts.motion if isinstance(contacts, LinearContacts) else contacts.gap_t
    if moving is not None and hasattr(m.method, "theta"):
        g_t = _own_rates(scene, m.t, m.q, m.v)
        work -= np.einsum("ij,ij->i", m.impulse[1:], 0.5 * (g_t[1:] + g_t[:-1]))
    elif moving is not None:  # impacts at their own times
        log = m.impacts[np.isin(m.impacts.kind, (Kind.IMPACT, Kind.ACCUMULATION))]
        g_t = _own_rates(scene, log.time, *m.at(log.time))[np.arange(len(log)), log.contact]
        at = _interval(m, log.time)
        work += np.bincount(at, weights=-log.impulse * g_t, minlength=len(work))
        rest = m.impulse[1:].copy()
        np.subtract.at(rest, (at, log.contact), log.impulse)
        held = np.any(np.abs(rest) > UNLOGGED * np.max(m.impulse, initial=0.0), axis=1)
    if m.friction_impulse.size:
        slip = _own_rates(scene, m.t, m.q, m.v, tangents=True)
        work -= np.einsum("ij,ij->i", m.friction_impulse[1:], 0.5 * (slip[1:] + slip[:-1]))
    return work, held


def _contacts(m: Trajectory) -> Array:
    """Dissipated on the normals between kept states: -p (u+ + u-)/2."""
    if hasattr(m.method, "theta") and m.scene.n_c and m.counts.steps == len(m.t) - 1:
        u = _own_rates(m.scene, m.t, m.q, m.v, moved=True)
        return -np.einsum("ij,ij->i", m.impulse[1:], 0.5 * (u[1:] + u[:-1]))
    return _binned(m, -0.5 * m.impacts.impulse * (m.impacts.before + m.impacts.after))


def _friction(m: Trajectory) -> Array:
    """Dissipated by friction between kept states: -p_T (u_T+ + u_T-)/2."""
    if not m.friction_impulse.size or len(m.t) < 2:
        return np.zeros(len(m.t) - 1)
    u = _own_rates(m.scene, m.t, m.q, m.v, tangents=True, moved=True)
    return -np.einsum("ij,ij->i", m.friction_impulse[1:], 0.5 * (u[1:] + u[:-1]))


def _own_rates(
    scene: Scene, t: Array, q: Array, v: Array, *, tangents: bool = False, moved: bool = False
) -> Array:
    """g_t of every contact, or slip of its tangent; with `moved` the whole gap velocity or sliding velocity."""
    out, contacts = np.zeros((len(t), scene.n_c)), scene.contacts
    if isinstance(contacts, LinearContacts) and not tangents and (contacts.sparse or contacts.motion is None):
        G: Any = contacts.G
        if contacts.motion is not None:
            s = np.zeros((scene.n_c, 3))
            for k in range(len(t)):
                contacts.motion(t[k], q[k], v[k], np.array(scene.p), s)
                out[k] = -s[:, 1]
        return out + (G @ v.T).T if moved else out
    friction = None if contacts is None else contacts.friction
    if tangents and friction is not None and not callable(friction.tangent):
        T: Any = friction.tangent
        slip = friction.slip
        belts = [slip.at(x, scene.n_c) for x in t.tolist()] if isinstance(slip, Harmonic) else slip
        return out + np.asarray(belts) + ((T @ v.T).T if moved else 0.0)
    m = (tangent_model if tangents else model)(scene)
    return states.own_rates(m, *map(np.ascontiguousarray, (t, q, v)), moved)
