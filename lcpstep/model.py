"""A scene as kernels see it: numbers, arrays and the addresses of the user's functions.

`model(scene)` compiles the scene's callbacks. Where numba cannot compile one, all are kept as they are, with a
warning, and the whole run takes the same kernels in plain Python.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, HybridScene, LinearContacts, LinearSystem, Scene
from lagrangian.checks import Callback
from lagrangian.joints import state as joint_state
from lagrangian.system import Harmonic
from lcpstep import callbacks, compiled
from lcpstep.callbacks import NotCompiled
from lcpstep.callbacks import UncompiledCallback as UncompiledCallback
from lcpstep.compiled import by_address
from lcpstep.errors import LcpStepError
from lcpstep.faults import fault, plain
from lcpstep.kernels import model as kernels
from lcpstep.kernels.uncompiled import CalledBack

Array = NDArray[np.float64]
LARGEST_DENSE = 2000  # rows or columns of a sparse matrix that a method may ask for as an array
TRIALS = 20  # evaluations of a callback at one state
ABSENT = 0  # in place of a callback that the scene does not have
TANGENT = {"jacobian": "tangent", "gap_t": "slip"}  # what is named so where tangents stand for normals


def require(scene: Scene, method: str, *, joints: bool, friction: bool) -> None:
    """Refuse a scene with features that the method does not treat, rather than leave them out."""
    if scene.n_j > 0 and not joints:
        raise LcpStepError(f"scene: {method} does not treat joints, and {scene.name!r} has {scene.n_j}")
    if scene.contacts is not None and scene.contacts.friction is not None and not friction:
        raise LcpStepError(f"scene: {method} does not treat friction, and {scene.name!r} has it")


def dense(name: str, matrix: Any) -> Array:
    """An array of its own from a dense or a sparse matrix; LcpStepError for one that is too large for that."""
    if not hasattr(matrix, "toarray"):
        return np.array(matrix)
    if max(matrix.shape) > LARGEST_DENSE:
        raise LcpStepError(
            f"{name}: this method works with dense matrices, and one of shape {matrix.shape} would need "
            f"{8e-9 * matrix.shape[0] * matrix.shape[1]:.1f} GB; Moreau takes sparse linear systems as they are"
        )
    return np.ascontiguousarray(matrix.toarray())


@by_address
class Model(NamedTuple):
    """Everything a kernel needs to evaluate a scene's equations; see `lagrangian` for the symbols."""

    linear: bool  # M v' + C v + K q = F(t); otherwise M(t, q) v' = force(t, q, v)
    M: Array
    M_inverse: Array
    C: Array
    K: Array
    constant: Array
    cosine: Array
    sine: Array
    omega: float
    force: Any
    frame: Any
    carried: bool  # kernels see q + c, in which the frame rests and obstacles move with it instead
    mass: Any
    force_q: Any
    force_v: Any
    flat: bool  # g = G q + offset - s(t); otherwise gap(t, q)
    G: Array
    offset: Array
    restitution: Array
    motion: Any
    gap: Any
    jacobian: Any
    gap_t: Any
    bias: Any
    p: Array
    frame_now: Array  # (n_q, 3), work space: c, c', c''
    motion_now: Array  # (n_c, 3), work space: s, s', s''


def model(scene: Scene) -> tuple[Model, bool]:
    """The scene's model, and whether every callback of it could be compiled."""
    (m,), fast = _models(scene, _system(scene), contacts=_contacts(scene, scene.contacts))
    return m, fast


def plain_model(scene: Scene) -> Model:
    """The scene's model with its callbacks as they are, for a few evaluations of its equations in plain Python."""
    return Model(**(_system(scene) | _contacts(scene, scene.contacts)))


def joint_model(scene: Scene) -> tuple[Model, bool]:
    """The scene's model with its joints in the place of the contacts, for the same kernels to evaluate."""
    (m,), fast = _models(scene, _system(scene), joints=_joints(scene))
    return m, fast


def tangent_model(scene: Scene) -> tuple[Model, bool]:
    """The scene's model with its contacts' tangents in the place of their normals; it knows no gap, only rates."""
    (m,), fast = _models(scene, _system(scene), friction=_tangents(scene))
    return m, fast


def models(scene: Scene) -> tuple[tuple[Model, Model, Model], bool]:
    """Models of the contacts, joints and tangents of a scene, any of them empty; whether all could be compiled."""
    friction = scene.contacts is not None and scene.contacts.friction is not None
    (normal, joint, tangent), fast = _models(
        scene,
        _system(scene),
        contacts=_contacts(scene, scene.contacts),
        joints=_joints(scene),
        friction=_tangents(scene) if friction else _contacts(scene, None),
    )
    return (normal, joint, tangent), fast


def _models(scene: Scene, own: dict[str, Any], **constraints: dict[str, Any]) -> tuple[list[Model], bool]:
    """A model for each kind of constraints; where one callback of any cannot be compiled, all are plain."""
    (system, *rows), fast = with_addresses(scene, system=own, **constraints)
    return [Model(**(system | row)) for row in rows], fast


def with_addresses(scene: Scene, **parts: dict[str, Any]) -> tuple[list[dict[str, Any]], bool]:
    """Fields with compiled callbacks in the place of plain ones; all are plain where one cannot be compiled."""
    given = {part: {name: f for name, f in fields.items() if callable(f)} for part, fields in parts.items()}
    made: dict[str, dict[str, Any]] = {part: {} for part in parts}
    if not compiled.jit_disabled():
        made = {part: _compile(scene, part, fs) for part, fs in given.items()}
    fast = all(len(made[part]) == len(fs) for part, fs in given.items())
    if not fast:
        made = {part: {name: plain(f) for name, f in fs.items()} for part, fs in given.items()}
    return [fields | made[part] for part, fields in parts.items()], fast


def kernel_model(scene: Scene) -> kernels.Model:
    """The scene's model as kernels built ahead of time take it."""
    return _kernel_model(scene, "contacts", _contacts(scene, scene.contacts))


def kernel_models(scene: Scene) -> tuple[kernels.Model, kernels.Model, kernels.Model]:
    """Models of the contacts, joints and tangents of a scene, any of them empty."""
    friction = scene.contacts is not None and scene.contacts.friction is not None
    tangents = _tangents(scene) if friction else _contacts(scene, None)
    return (
        kernel_model(scene),
        _kernel_model(scene, "joints", _joints(scene)),
        _kernel_model(scene, "friction", tangents),
    )


def kernel_joint_model(scene: Scene) -> kernels.Model:
    """The scene's model with its joints in the place of the contacts, for the same kernels to evaluate."""
    return _kernel_model(scene, "joints", _joints(scene))


def kernel_tangent_model(scene: Scene) -> kernels.Model:
    """The scene's model with its contacts' tangents in the place of their normals; it knows no gap, only rates."""
    return _kernel_model(scene, "friction", _tangents(scene))


def _kernel_model(scene: Scene, part: str, rows: dict[str, Any]) -> kernels.Model:
    """A model whose functions are C functions: compiled, or around Python."""
    own = _system(scene)
    called_back: list[CalledBack] = []
    for name, fields in (("system", own), (part, rows)):
        given = {field: f for field, f in fields.items() if callable(f)}
        made = {} if compiled.jit_disabled() else _compile(scene, name, given, callbacks.plain_address)
        for field, f in given.items():
            if field not in made:
                called_back.append(CalledBack(f))
                made[field] = called_back[-1].address
        fields |= made
    return kernels.Model(own | rows | {"called_back": called_back})


def _compile(
    scene: Scene,
    part: str,
    given: dict[str, Callback],
    address: Callable[[Callback, int], int] = callbacks.address,
) -> dict[str, int]:
    addresses = {}
    for name, f in given.items():
        ndim = 1 if name in ("force", "gap", "gap_t", "bias") else 2
        try:
            addresses[name] = address(f, ndim)
        except NotCompiled as why:
            said = TANGENT.get(name, name) if part == "friction" else name
            prefix = "" if part in ("system", "contacts") else f"{part}."
            callbacks.warn(f"{prefix}{said} of scene {scene.name!r}", f, why)
    return addresses


def called_model(scene: Scene) -> kernels.Model:
    """The model of scene and contacts with its functions in Python: for a few evaluations, without compiling any."""
    fields, called_back = _system(scene) | _contacts(scene, scene.contacts), []
    for name, f in fields.items():
        if callable(f):
            called_back.append(CalledBack(f))
            fields[name] = called_back[-1].address
    return kernels.Model(fields | {"called_back": called_back})


def culprit(scene: Scene, times: Iterable[float], q: Array, v: Array) -> str:
    """Which callback has raised an exception, or is not finite at one of the times, in words."""
    found = failing(scene, times, q, v)
    return found or "the motion left the finite numbers, or a matrix is singular or not positive definite,"


def failing(scene: Scene, times: Iterable[float], q: Array, v: Array) -> str:
    """The callback that has raised an exception, or is not finite at one of the times; "" if none does.

    It is asked for at the state that the motion has reached, and at those that this leads to in a straight line.
    """
    raised, times = fault(), list(times)
    states = [(t, q, v) for t in times] + [(t, q + (t - times[0]) * v, v) for t in times]
    if raised is not None:
        states = [(raised.t, raised.q, raised.v)]
    try:
        for t, x, x_t in states:
            at = t, x, x_t, np.array(scene.p)
            scene.system.trial(*at)
            if scene.contacts is not None:
                scene.contacts.state(*at)
            if scene.joints is not None:
                joint_state(scene.joints, *at)
    except ValueError as error:
        return str(error) + ";"
    if raised is not None:
        return f"{raised};"
    return ""


def unrepeatable(scene: Scene, t: float, q: Array, v: Array) -> list[str]:
    """The callbacks that answer the same question twice with other numbers."""
    n_q, n_c = scene.n_q, scene.n_c
    shapes = {"force": (n_q,), "frame": (n_q, 3), "mass": (n_q, n_q), "motion": (n_c, 3)}
    shapes |= {"gap": (n_c,), "jacobian": (n_c, n_q), "gap_t": (n_c,), "bias": (n_c,)}
    fields, found = plain_model(scene)._asdict(), []
    for name, shape in shapes.items():
        if callable(f := fields[name]):
            first, again = np.zeros((2, *shape))
            f(t, q, v, fields["p"], first)
            for _ in range(TRIALS):
                f(t, q, v, fields["p"], again)
                if not np.array_equal(first, again):
                    found.append(name)
                    break
    return found


def hybrid_culprit(scene: HybridScene, mode: str) -> str:
    """The same of a system with modes that has stopped in this one."""
    raised = fault()
    if raised is None:
        return f"the field of mode {mode!r}, a guard of it or the state is not finite"
    try:
        scene.system.trial(raised.t, raised.q, np.array(scene.p))
    except ValueError as error:
        return str(error)
    return str(raised)


def _system(scene: Scene) -> dict[str, Any]:
    n_q, system = scene.n_q, scene.system
    zero, square = np.zeros(n_q), np.zeros((n_q, n_q))
    fields: dict[str, Any] = dict.fromkeys(("force", "frame", "mass", "force_q", "force_v"), ABSENT)
    fields |= {"constant": zero, "cosine": zero, "sine": zero, "omega": 0.0, "C": square, "K": square}
    fields |= {"p": np.array(scene.p), "frame_now": np.zeros((n_q, 3)), "carried": False}
    if isinstance(system, LinearSystem):
        M = dense("M", system.M)
        fields |= {"C": dense("C", system.C), "K": dense("K", system.K), "frame": system.frame or ABSENT}
        if isinstance(system.force, Harmonic):
            terms = dict(zip(("constant", "cosine", "sine"), system.force.terms(n_q), strict=True))
            fields |= {name: np.array(term) for name, term in terms.items()}
            fields["omega"] = float(system.force.omega)
        else:
            fields["force"] = system.force
    else:
        M = square if callable(system.mass) else np.array(system.mass)
        fields |= {"force": system.force, "mass": system.mass if callable(system.mass) else ABSENT}
        fields |= {"force_q": system.force_q or ABSENT, "force_v": system.force_v or ABSENT}
    inverse = np.linalg.inv(M) if np.any(M) else square
    return fields | {"linear": isinstance(system, LinearSystem), "M": M, "M_inverse": inverse}


def _tangents(scene: Scene) -> dict[str, Any]:
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is None:
        raise ValueError(f"scene: {scene.name!r} has no friction")
    fields = _contacts(scene, None) | {"restitution": np.zeros(scene.n_c), "offset": np.zeros(scene.n_c)}
    motion = np.zeros((scene.n_c, 3))
    if callable(friction.tangent):
        slip = friction.slip if callable(friction.slip) else ABSENT
        fields |= {"flat": False, "jacobian": friction.tangent, "gap_t": slip}
    else:
        motion[:, 1] = -np.asarray(friction.slip)
        fields |= {"G": np.array(friction.tangent)}
    return fields | {"motion_now": motion}


def _joints(scene: Scene) -> dict[str, Any]:
    return _contacts(scene, None if scene.joints is None else scene.joints.as_contacts())


def _contacts(scene: Scene, contacts: LinearContacts | Contacts | None) -> dict[str, Any]:
    n_q, n_c = scene.n_q, 0 if contacts is None else contacts.n_c
    fields: dict[str, Any] = dict.fromkeys(("motion", "gap", "jacobian", "gap_t", "bias"), ABSENT)
    fields |= {"flat": True, "G": np.zeros((n_c, n_q)), "offset": np.zeros(n_c)}
    fields |= {"restitution": np.zeros(n_c), "motion_now": np.zeros((n_c, 3))}
    if contacts is None:
        return fields
    fields["restitution"] = np.array(contacts.restitution)
    if isinstance(contacts, LinearContacts):
        return fields | {
            "G": dense("G", contacts.G),
            "offset": np.array(contacts.offset),
            "motion": contacts.motion or ABSENT,
        }
    return fields | {
        "flat": False,
        "gap": contacts.gap,
        "jacobian": contacts.jacobian,
        "gap_t": contacts.gap_t or ABSENT,
        "bias": contacts.bias or ABSENT,
    }
