"""What a scene has beside frictionless contacts, made ready for the loop of `constrained`."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.lcp.kernel import room, solver
from lcpstep.model import Model
from lcpstep.stepping import constrained
from lcpstep.stepping.friction import Problem
from lcpstep.stepping.joints import elimination
from lcpstep.stepping.theta import State


def frictional(scene: Scene) -> bool:
    """Whether any contact of the scene has friction."""
    return scene.contacts is not None and scene.contacts.friction is not None


def constraints(
    scene: Scene, m: Model, joints: Model, tangents: Model, projected: bool, fast: bool
) -> constrained.Constraints:
    """Joints and tangents of a scene, with the work space of a step that has them."""
    n_q, n_c, n_j, n_t = scene.n_q, scene.n_c, scene.n_j, len(tangents.offset)
    n = n_c + n_t + n_j
    friction = None if scene.contacts is None else scene.contacts.friction
    tangential = None if friction is None else friction.restitution
    wide = {name: np.zeros((n, n_q)) for name in ("H", "X")}
    long = {name: np.zeros(n) for name in ("H_t", "b", "p")}
    ids = np.zeros(n, dtype=np.int64)
    H, H_t, first_joint = wide["H"], long["H_t"], n_c + n_t
    return constrained.Constraints(
        joints=joints, tangents=tangents, projected=projected,
        tangent_restitution=m.restitution if tangential is None else np.array(tangential),
        constant=m.linear and m.flat and joints.flat and tangents.flat and not projected,
        first_joint=first_joint, T=H[n_c:first_joint], T_t=H_t[n_c:first_joint],
        J=H[first_joint:], J_t=H_t[first_joint:], J_start=np.zeros((n_j, n_q)), D=np.zeros((n_j, n_q)),
        W=np.zeros((n, n)), sliding=np.zeros(n_t), gaps=np.zeros(n_c), joint_gaps=np.zeros(n_j),
        M=np.zeros((n_q, n_q)), ids=ids, near=np.zeros(n_c, dtype=np.int64), failed=np.zeros(n_j, dtype=np.int64),
        joint_work=elimination(n_j, n_c), problem=problem(scene, ids, fast), **wide, **long,
    )  # fmt: skip


def problem(scene: Scene, ids: Any, fast: bool) -> Problem:
    """Room for the contacts' complementarity problem, with the solver for its size."""
    n_c, friction = scene.n_c, None if scene.contacts is None else scene.contacts.friction
    n = n_c if friction is None else 4 * n_c
    return Problem(
        R=np.zeros(4 * n_c * n_c),
        reduced=np.zeros(2 * n_c),
        solution=np.zeros(2 * n_c),
        mu=np.zeros(n_c) if friction is None else np.array(friction.mu),
        ids=ids,
        carrier=np.zeros(n_c, dtype=np.int64),
        W=np.zeros(n * n),
        b=np.zeros(n),
        z=np.zeros(n),
        solver=solver(fast),
        work=room(n, fast),
    )


def enlarged(state: State, c: constrained.Constraints) -> State:
    """The state of a step with room for all impulses, its rows those of c."""
    n_c = len(state.u)
    return state._replace(G=c.H[:n_c], g_t=c.H_t[:n_c], impulse=np.zeros(len(c.p)))
