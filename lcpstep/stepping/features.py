"""What a scene has beside frictionless contacts, made ready for the loop of `constrained`."""

from __future__ import annotations

from typing import Any

import numpy as np

from lagrangian import Scene
from lcpstep.lcp.kernel import workspace
from lcpstep.model import Model
from lcpstep.stepping import constrained
from lcpstep.stepping.joints import elimination


def frictional(scene: Scene) -> bool:
    """Whether any contact of the scene has friction."""
    return scene.contacts is not None and scene.contacts.friction is not None


def constraints(
    scene: Scene, m: Model, joints: Model, tangents: Model, projected: bool
) -> constrained.Constraints:
    """Joints and tangents of a scene, with the work space of a step that has them."""
    n_q, n_c, n_j, n_t = scene.n_q, scene.n_c, scene.n_j, len(tangents.offset)
    n = n_c + n_t + n_j
    mu, tangent_restitution = np.zeros(n_c), m.restitution
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is not None:
        mu = np.array(friction.mu)
        tangent_restitution = (
            m.restitution if friction.restitution is None else np.array(friction.restitution)
        )
    wide = {name: np.zeros((n, n_q)) for name in ("H", "X")}
    long = {name: np.zeros(n) for name in ("H_t", "b", "p")}
    marks = {"ids": n, "carrier": n_c, "near": n_c, "failed": n_j}
    H, H_t, first_joint = wide["H"], long["H_t"], n_c + n_t
    return constrained.Constraints(
        joints=joints, tangents=tangents, mu=mu, tangent_restitution=tangent_restitution,
        constant=m.linear and m.flat and joints.flat and tangents.flat and not projected, projected=projected,
        first_joint=first_joint, T=H[n_c:first_joint], T_t=H_t[n_c:first_joint],
        J=H[first_joint:], J_t=H_t[first_joint:], J_start=np.zeros((n_j, n_q)), D=np.zeros((n_j, n_q)),
        W=np.zeros((n, n)), sliding=np.zeros(n_t), gaps=np.zeros(n_c), joint_gaps=np.zeros(n_j),
        M=np.zeros((n_q, n_q)), R=np.zeros(4 * n_c * n_c), reduced=np.zeros(2 * n_c), solution=np.zeros(2 * n_c),
        joint_work=elimination(n_j, n_c), **wide, **long,
        **{name: np.zeros(size, dtype=np.int64) for name, size in marks.items()},
    )  # fmt: skip


def enlarged(scene: Scene, state: Any, c: constrained.Constraints) -> Any:
    """The state of a step with room for all impulses and the friction's unknowns; its rows are those of c."""
    n_c, n_t = scene.n_c, scene.n_c if frictional(scene) else 0
    n = n_c + 3 * n_t
    return state._replace(
        G=c.H[:n_c],
        g_t=c.H_t[:n_c],
        W=np.zeros(n * n),
        b=np.zeros(n),
        z=np.zeros(n),
        lcp=workspace(max(n, 1)),
        impulse=np.zeros(n_c + n_t + scene.n_j),
    )
