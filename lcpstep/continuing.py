"""The scene that goes on from the end of a run, by whatever method.

A method leaves contacts and joints as near to g = 0 as it is exact; a scene starts outside of its obstacles and on
its joints. The smallest change of the position in the metric of the mass that repairs this,

    minimise dq^T M dq / 2    with    g_J + G_J dq = 0  on joints,  g + G dq >= 0  on contacts,

is repeated for curved gaps until all hold. Velocities change by the smallest dv for which joints have no rate, and
contacts that rest neither. Source: as of `lcpstep.stepping.theta_method.repair`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from lagrangian import HybridScene, LinearContacts, LinearSystem, Scene, checks
from lagrangian.scene import ROUNDING
from lcpstep.answer import Answer
from lcpstep.errors import LcpStepError
from lcpstep.lcp import solve_lcp
from lcpstep.model import dense
from lcpstep.trajectory import Kind
from lcpstep.warned import warn

if TYPE_CHECKING:
    from lcpstep.events.hybrid.trajectory import HybridTrajectory
    from lcpstep.trajectory import Trajectory

Array = NDArray[np.float64]
REPEATED = 20  # times that a curved gap is taken as straight
REFINED = 3  # times that contacts at rest are closed, until what is left is zero
MOST = 5  # contacts named in a warning
LEAST = np.finfo(
    float
).tiny  # below it numbers have lost their digits: what rounding leaves of what has underflowed
TINY = 1e-16  # relative residual of a large system
AT_REST = (
    Kind.STICK,
    Kind.ACCUMULATION,
    Kind.SLIP,
    Kind.STICK_TANGENT,
    Kind.REVERSE,
)  # after which a contact stays closed


class PutBack(UserWarning):
    """A position at the end of a run that was moved, since a scene cannot start there."""


@overload
def continued(run: Trajectory, *, t_end: float) -> Scene: ...
@overload
def continued(run: HybridTrajectory, *, t_end: float) -> HybridScene: ...
def continued(run: Trajectory | HybridTrajectory, *, t_end: float) -> Scene | HybridScene:
    """The scene that starts where a run ended: its last state, the same system, contacts and joints.

    Parameters
    ----------
    run : Trajectory or HybridTrajectory, finished or not, by any method. It goes on from its last kept state
    t_end : end of the new span [s]

    Returns
    -------
    Scene or HybridScene with t_span = (run.t[-1], t_end), to be run by any method; a motion in closed form (`exact`)
        is dropped. Contacts that rest start closed, at gap 0 and rate 0; what lay inside an obstacle or off a joint
        is put back onto it, and a `PutBack` warning names contact or joint and how far

    Raises
    ------
    TypeError   run is none
    ValueError   t_end is not after the end of the run, or no state of the run was kept
    LcpStepError   no position near satisfies all joints and contacts
    """
    if not isinstance(run, Answer):
        raise TypeError(f"run: expected a Trajectory, got {run!r}")
    t_end = checks.number("t_end", t_end)
    if isinstance(run.scene, HybridScene):
        return _continued_modes(run, t_end)
    if len(run.t) == 0:
        raise ValueError("run: expected one that has kept a state to go on from")
    scene, t = run.scene, _after(run.t[-1], t_end)
    rests = _resting(run)
    q = _position(scene, t, run.q[-1], run.v[-1], rests)
    v = _velocity(scene, t, q, run.v[-1], rests)
    return replace(scene, q0=q, v0=v, t_span=(t, t_end), exact=None)


def _after(t: float, t_end: float) -> float:
    if not t_end > t:
        raise ValueError(f"t_end: expected a time after the end of the run, {t:.9g} s, got {t_end!r}")
    return float(t)


def _continued_modes(run: Any, t_end: float) -> HybridScene:
    """From the last step of a run with modes, which is known whatever was kept."""
    names, last = run.scene.system.names, run.pieces
    t = _after(last.t[-1], t_end)
    return run.scene.started(last.x[-1], names[last.mode[-1]], (t, t_end))


def _resting(run: Trajectory) -> NDArray[np.bool_]:
    """Which contacts are closed for a while at the end of a run, by its log or by their gap and rate, (n_c,)."""
    scene, log = run.scene, run.impacts
    g, u = scene.gap(run.t[-1], run.q[-1], run.v[-1])
    rests = (np.abs(g) <= _slack(run.q[-1])) & (np.abs(u) <= _slack(run.v[-1]))
    for contact in np.unique(log.contact):
        rests[contact] |= log.kind[log.contact == contact][-1] in AT_REST
    return rests


def _slack(x: Array) -> float:
    """What rounding makes of numbers of this size."""
    return float(ROUNDING * max(1.0, np.max(np.abs(x))))


def _position(scene: Scene, t: float, q: Array, v: Array, rests: NDArray[np.bool_]) -> Array:
    """The position, put back onto joints and out of obstacles where it has to be, and onto those it rests on."""
    found, slack, near = q.copy(), _slack(q), rests.copy()
    for _ in range(REPEATED):
        rows = Rows.at(scene, t, found, v)
        if np.all(rows.g >= -slack) and np.all(np.abs(rows.off) <= slack):
            break
        near |= rows.g < 0.0
        found = moved(found, rows.outwards(np.flatnonzero(near)))
    else:
        raise LcpStepError(
            f"run: no position near its end satisfies all joints and contacts of {scene.name!r}: at t = {t:.9g} s "
            f"gaps are {checks.shown(rows.g)} m, joints off by {checks.shown(rows.off)} m"
        )
    closed, after = found, Rows.at(scene, t, found, v)
    for _ in range(REFINED):
        closed = moved(closed, after.onto(rests, np.concatenate([after.g[rests], after.off])))
        after = Rows.at(scene, t, closed, v)
    if np.all(after.g >= -slack) and np.all(np.abs(np.concatenate([after.g[rests], after.off])) <= slack):
        found = closed
    _tell(scene, Rows.at(scene, t, q, v), Rows.at(scene, t, found, v), slack)
    return found


def _velocity(scene: Scene, t: float, q: Array, v: Array, rests: NDArray[np.bool_]) -> Array:
    """The velocity without the rates of joints and of contacts that rest."""
    for _ in range(REFINED):
        rows = Rows.at(scene, t, q, v)
        v = moved(v, rows.onto(rests, np.concatenate([rows.u[rests], rows.off_rate])))
    return v


def moved(x: Array, d: Array) -> Array:
    """X + d, where what d cancels to rounding is zero: nothing else would give the scene its scale."""
    y = x + d
    y[np.abs(y) <= max(ROUNDING * np.max(np.abs(d)), LEAST)] = 0.0
    return y


def _tell(scene: Scene, before: Rows, after: Rows, slack: float) -> None:
    """Say which contacts and joints were moved by more than rounding."""
    said = [
        f"{name} {k} by {abs(change[k]):.3g} m"
        for name, change in (("contact", after.g - before.g), ("joint", after.off - before.off))
        for k in np.flatnonzero(np.abs(change) > slack)
    ]
    if said:
        more = f" and {len(said) - MOST} more" if len(said) > MOST else ""
        warn(
            f"the end of the run of {scene.name!r} was put back onto {', '.join(said[:MOST])}{more}", PutBack
        )


@dataclass(frozen=True, eq=False)
class Rows:
    """Mass, contacts and joints at a state: M, gaps g and rates u, G; what joints are off, how fast, J."""

    M: Any
    g: Array
    u: Array
    G: Any
    off: Array
    off_rate: Array
    J: Any

    @classmethod
    def at(cls, scene: Scene, t: float, q: Array, v: Array) -> Rows:
        """The rows of a scene."""
        at, system = (t, q, v, np.array(scene.p)), scene.system
        joints = None if scene.joints is None else scene.joints.as_contacts()
        M: Any = system.M if isinstance(system, LinearSystem) else system.mass
        if callable(M):
            M = checks.evaluate("system.mass", M, at, (scene.n_q, scene.n_q))
        contacts, bilateral = ([*_state(x, at), _jacobian(x, at)] for x in (scene.contacts, joints))
        if scene.n_j > 0:  # no method takes these sparse
            M, contacts[2], bilateral[2] = dense("M", M), dense("G", contacts[2]), dense("G", bilateral[2])
        return cls(M, *contacts, *bilateral)

    def outwards(self, near: Any) -> Array:
        """Smallest dq with g + G dq >= 0 on the contacts near, and joints on zero."""
        if hasattr(self.M, "toarray") or hasattr(self.G, "toarray"):
            return self._outwards_sparse(near)
        G, J = self.G[near], self.J
        X_G, X_J = np.linalg.solve(self.M, G.T), np.linalg.solve(self.M, J.T)
        response = np.linalg.pinv(J @ X_J)
        dq = -X_J @ (response @ self.off)
        free = X_G - X_J @ (response @ (J @ X_G))  # of an impulse of each contact, the joints held
        result: Array = dq + free @ solve_lcp(G @ free, self.g[near] + G @ dq).z
        return result

    def _outwards_sparse(self, near: Any) -> Array:
        """The same for sparse matrices, without joints."""
        from lcpstep.lcp.saddle import Problem, Saddle

        g, n = self.g[near], self.M.shape[0]
        problem = Problem(np.zeros(n), g, np.maximum(np.abs(g), 1.0), np.ones(len(g), dtype=bool))
        found = Saddle(self.M, csr(self.G)[near]).solve(problem, g < 0.0, np.zeros(len(g)))
        return np.asarray(found.x)

    def onto(self, closed: NDArray[np.bool_], r: Array) -> Array:
        """Smallest d with r + H d = 0, H the rows of the closed contacts and then the joints; nothing where r = 0."""
        if not np.any(r):
            return np.zeros(self.M.shape[0])
        if hasattr(self.M, "toarray") or hasattr(self.G, "toarray"):
            from scipy.sparse.linalg import lsqr

            size = np.sqrt(self.M.diagonal())  # the metric of the mass's diagonal
            return np.asarray(lsqr(csr(self.G)[closed] / size, -r, atol=TINY, btol=TINY)[0] / size)
        H = np.concatenate([self.G[closed], self.J])
        X = np.linalg.solve(self.M, H.T)
        result: Array = X @ np.linalg.lstsq(H @ X, -r, rcond=None)[0]
        return result


def _state(constraints: Any, at: Any) -> list[Array]:
    """Gaps and their rates; none of no constraints."""
    return [np.zeros(0), np.zeros(0)] if constraints is None else list(constraints.state(*at))


def _jacobian(constraints: Any, at: Any) -> Any:
    """G = dg/dq."""
    n_q = len(at[1])
    if constraints is None:
        return np.zeros((0, n_q))
    if isinstance(constraints, LinearContacts):
        return constraints.G
    return checks.evaluate("jacobian", constraints.jacobian, at, (constraints.n_c, n_q))


def csr(matrix: Any) -> Any:
    """A matrix with rows to choose, sparse."""
    from scipy.sparse import csr_array

    return csr_array(matrix)
