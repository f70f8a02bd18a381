"""A scene as kernels see it: numbers, arrays and the addresses of the user's functions.

`model(scene)` compiles the scene's callbacks. One that numba cannot compile is kept as it is, with a warning,
and the whole run then takes the same kernels in plain Python.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene
from lagrangian.checks import Callback
from lagrangian.system import Harmonic
from lcpstep import compiled
from lcpstep.compiled import by_address
from lcpstep.errors import LcpStepError

Array = NDArray[np.float64]
LARGEST_DENSE = 2000  # rows or columns of a sparse matrix that a method may ask for as an array
TRIALS = 20  # evaluations of a callback at one state
ABSENT = 0  # in place of a callback that the scene does not have


class UncompiledCallback(UserWarning):
    """A user's function that numba cannot compile; the run takes plain Python, some hundred times slower."""


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
    return _model(scene, _system(scene) | _contacts(scene, scene.contacts))


def plain_model(scene: Scene) -> Model:
    """The scene's model with its callbacks as they are, for a few evaluations of its equations in plain Python."""
    return Model(**(_system(scene) | _contacts(scene, scene.contacts)))


def joint_model(scene: Scene) -> tuple[Model, bool]:
    """The scene's model with its joints in the place of the contacts, for the same kernels to evaluate."""
    contacts = None if scene.joints is None else scene.joints.as_contacts()
    return _model(scene, _system(scene) | _contacts(scene, contacts))


def tangent_model(scene: Scene) -> tuple[Model, bool]:
    """The scene's model with its contacts' tangents in the place of their normals; it knows no gap, only rates."""
    return _model(scene, _system(scene) | _tangents(scene))


def models(scene: Scene) -> tuple[tuple[Model, Model, Model], bool]:
    """Models of the contacts, joints and tangents of a scene, any of them empty; whether all could be compiled."""
    joints = None if scene.joints is None else scene.joints.as_contacts()
    friction = scene.contacts is not None and scene.contacts.friction is not None
    tangents = _tangents(scene) if friction else _contacts(scene, None)
    fields = [
        _system(scene) | x for x in (_contacts(scene, scene.contacts), _contacts(scene, joints), tangents)
    ]
    made = [_model(scene, each) for each in fields]
    fast = all(compiled_too for _, compiled_too in made)
    normal, joint, tangent = (m if fast else Model(**f) for (m, _), f in zip(made, fields, strict=True))
    return (normal, joint, tangent), fast


def _model(scene: Scene, fields: dict[str, Any]) -> tuple[Model, bool]:
    fields, fast = with_addresses(scene, fields)
    return Model(**fields), fast


def with_addresses(scene: Scene, fields: dict[str, Any]) -> tuple[dict[str, Any], bool]:
    """The fields with compiled callbacks in the place of plain ones; all are plain where one cannot be compiled."""
    callbacks = {name: f for name, f in fields.items() if callable(f)}
    addresses = {} if compiled.jit_disabled() else _compile(scene, callbacks)
    fast = len(addresses) == len(callbacks)
    return (fields | addresses if fast else fields), fast


def _compile(scene: Scene, callbacks: dict[str, Callback]) -> dict[str, int]:
    addresses = {}
    for name, f in callbacks.items():
        ndim = 1 if name in ("force", "gap", "gap_t", "bias") else 2
        try:
            addresses[name] = compiled.address(f, ndim)
        except Exception as error:  # numba's errors share no base class
            reason = str(error).strip().splitlines()[0] if str(error) else type(error).__name__
            warnings.warn(
                f"{name} of scene {scene.name!r} cannot be compiled and runs in plain Python: {reason}",
                UncompiledCallback,
                stacklevel=5,
            )
    return addresses


def culprit(scene: Scene, times: Iterable[float], q: Array, v: Array) -> str:
    """Which callback is not finite at a state, at the first of the given times where one is, in words."""
    try:
        for t in times:
            scene.system.trial(t, q, v, np.array(scene.p))
            scene.gap(t, q, v)
    except ValueError as error:
        return str(error) + ";"
    return "the motion left the finite numbers, or a matrix is singular or not positive definite,"


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
