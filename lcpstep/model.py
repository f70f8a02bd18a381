"""From a scene to the model that kernels see: numbers, arrays and the addresses of the user's functions.

`model(scene)` compiles the scene's callbacks. One that numba cannot compile stays in Python, with a warning, and is
called back from the kernels: the run is slower by that function alone.
"""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from typing import Any, cast
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lagrangian import Contacts, LinearContacts, LinearSystem, Scene, System
from lagrangian.checks import Callback
from lagrangian.friction import sway, swaying
from lagrangian.system import Harmonic
from lcpstep.callbacks import NotCompiled, compiling
from lcpstep.callbacks import UncompiledCallback as UncompiledCallback
from lcpstep.kernels import model as kernels
from lcpstep.kernels.coefficients import Coefficients
from lcpstep.kernels.function import Functions
from lcpstep.kernels.uncompiled import CalledBack
from lcpstep.refusals import refused

Array = NDArray[np.float64]
LARGEST_DENSE = 2000  # rows or columns of a sparse matrix that a method may ask for as an array
LARGEST_KEPT = 200  # coordinates of a system whose numbers stay with it, and with its contacts
KEPT: WeakKeyDictionary[Any, dict[str, Any]] = WeakKeyDictionary()  # numbers of both, which never change
LATEST = threading.local()  # .scene, .model, .joints: the last ones made in this thread, of few coordinates
TRIALS = 20  # evaluations of a callback at one state
ABSENT = 0  # in place of a callback that the scene does not have
TANGENT = {"jacobian": "tangent", "gap_t": "slip"}  # what is named so where tangents stand for normals


def dense(name: str, matrix: Any) -> Array:
    """An array of its own from a dense or a sparse matrix; LcpStepError for one that is too large for that."""
    if not hasattr(matrix, "toarray"):
        return np.array(matrix, order="C")
    if max(matrix.shape) > LARGEST_DENSE:
        raise refused("dense", argument=name)
    return np.ascontiguousarray(matrix.toarray())


def model(scene: Scene) -> kernels.Model:
    """The scene's model as kernels built ahead of time take it."""
    return _latest(scene, _models(scene, _system(scene), contacts=_contacts(scene, scene.contacts))[0])


def at_hand(scene: Scene) -> kernels.Model | None:
    """The model of the run just made, where it is of this scene; `carried` it may be."""
    return cast(kernels.Model, LATEST.model) if getattr(LATEST, "scene", None) is scene else None


def looked_at(scene: Scene) -> kernels.Model:
    """A model to evaluate states of a scene with, between runs: that of the run just made, where it is of this scene.

    The one in coordinates of its own (`carried`) sees other states.
    """
    made = at_hand(scene)
    return model(scene) if made is None or made.carried else made


def joints_looked_at(scene: Scene) -> kernels.Model:
    """The same of its joints."""
    made = getattr(LATEST, "joints", None) if at_hand(scene) is not None else None
    return joint_model(scene) if made is None else cast(kernels.Model, made)


def _latest(scene: Scene, made: kernels.Model, joints: kernels.Model | None = None) -> kernels.Model:
    few = scene.n_q <= LARGEST_KEPT
    LATEST.scene, LATEST.model, LATEST.joints = (scene, made, joints) if few else (None, None, None)
    return made


def models(
    scene: Scene, modes: Functions | None = None
) -> tuple[kernels.Model, kernels.Model, kernels.Model]:
    """Models of the contacts, joints and tangents of a scene, any of them empty.

    modes : the fields (v, a) of all modes, of a system whose force is that of a mode
    """
    own = _system(scene) if modes is None else _system(scene) | {"force": ABSENT, "modes": modes}
    parts = {"contacts": _contacts(scene, scene.contacts)}
    if scene.n_j > 0:
        parts["joints"] = _joints(scene)
    if scene.contacts is not None and scene.contacts.friction is not None:
        parts["friction"] = _tangents(scene)
    made = dict(zip(parts, _models(scene, own, **parts), strict=True))
    nothing = _empty(scene.n_q)
    contacts = _latest(scene, made["contacts"], made.get("joints"))
    return contacts, made.get("joints", nothing), made.get("friction", nothing)


@functools.cache
def _empty(n_q: int) -> kernels.Model:
    """A model that has neither forces nor rows."""
    return model(Scene(LinearSystem(np.eye(n_q)), np.zeros(n_q), np.zeros(n_q), (0.0, 1.0)))


def joint_model(scene: Scene) -> kernels.Model:
    """The scene's model with its joints in the place of the contacts, for the same kernels to evaluate."""
    made = _models(scene, _system(scene), joints=_joints(scene))[0]
    if at_hand(scene) is not None:
        LATEST.joints = made
    return made


def tangent_model(scene: Scene) -> kernels.Model:
    """The scene's model with its contacts' tangents in the place of their normals; it knows no gap, only rates."""
    return _models(scene, _system(scene), friction=_tangents(scene))[0]


def coefficients(scene: Scene) -> Coefficients:
    """The coefficients of friction of a scene's contacts, zero where it has none."""
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is None:
        return Coefficients(None, None, np.zeros(0), scene.n_q, scene.n_c, None)
    mu, called_back = friction.mu, None
    if callable(mu):
        made, called_back = c_functions(scene, friction={"mu": mu})
        mu = made["friction"]["mu"]
    return Coefficients(mu, friction.mu_s, np.array(scene.p), scene.n_q, scene.n_c, called_back)


def _models(scene: Scene, own: dict[str, Any], **constraints: dict[str, Any]) -> list[kernels.Model]:
    """A model for each kind of constraints, its functions C functions: compiled, or around Python."""
    functions, called_back = c_functions(scene, system=own, **constraints)
    own |= functions["system"] | {"called_back": called_back}
    return [kernels.Model(own | rows | functions[part]) for part, rows in constraints.items()]


def c_functions(scene: Scene, **parts: dict[str, Any]) -> tuple[dict[str, dict[str, int]], list[CalledBack]]:
    """Addresses of C functions for the callbacks among the fields of each part; what must be kept as long."""
    called_back: list[CalledBack] = []
    made: dict[str, dict[str, int]] = {}
    in_machine_code = not compiling.disabled()
    for part, fields in parts.items():
        given = {name: f for name, f in fields.items() if callable(f)}
        made[part] = _compile(scene, part, given) if in_machine_code else {}
        for name, f in given.items():
            if name not in made[part]:
                called_back.append(CalledBack(f))
                made[part][name] = called_back[-1].address
    return made, called_back


def _compile(scene: Scene, part: str, given: dict[str, Callback]) -> dict[str, int]:
    addresses = {}
    for name, f in given.items():
        ndim = 1 if name in ("force", "gap", "gap_t", "bias", "mu", "entries") else 2
        try:
            addresses[name] = compiling.address(f, ndim)
        except NotCompiled as why:
            said = TANGENT.get(name, name) if part == "friction" else {"entries": "jacobian"}.get(name, name)
            prefix = "" if part in ("system", "contacts") else f"{part}."
            compiling.warn(f"{prefix}{said} of scene {scene.name!r}", f, why)
    return addresses


def unrepeatable(scene: Scene, t: float, q: Array, v: Array) -> list[str]:
    """The callbacks that answer the same question twice with other numbers."""
    n_q, n_c = scene.n_q, scene.n_c
    shapes = {"force": (n_q,), "frame": (n_q, 3), "mass": (n_q, n_q), "motion": (n_c, 3)}
    shapes |= {"gap": (n_c,), "jacobian": (n_c, n_q), "gap_t": (n_c,), "bias": (n_c,)}
    fields, found = _system(scene) | _contacts(scene, scene.contacts), []
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
    known = _known(scene.system, _equations, scene)
    return known | {"p": np.array(scene.p), "frame_now": np.zeros((scene.n_q, 3)), "carried": False}


def _known(part: Any, read: Callable[[Any], dict[str, Any]], scene: Scene) -> dict[str, Any]:
    """Numbers and functions of a system or of contacts, read once; models of it share the arrays."""
    known = KEPT.get(part)
    if known is None:
        known = read(part)
        for name, x in known.items():
            if isinstance(x, np.ndarray):
                known[name] = np.ascontiguousarray(x)
                known[name].flags.writeable = False
        if scene.n_q <= LARGEST_KEPT and scene.n_c <= LARGEST_KEPT:
            KEPT[part] = known
    return known


def _equations(system: LinearSystem | System) -> dict[str, Any]:
    n_q = system.n_q
    zero, square = np.zeros(n_q), np.zeros((n_q, n_q))
    fields: dict[str, Any] = dict.fromkeys(("force", "frame", "mass", "force_q", "force_v"), ABSENT)
    fields |= {"constant": zero, "cosine": zero, "sine": zero, "omega": 0.0, "C": square, "K": square}
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
    fields |= {"M_ends": ends(inverse), "C_ends": ends(fields["C"], fields["K"])}
    return fields | {"linear": isinstance(system, LinearSystem), "M": M, "M_inverse": inverse}


def ends(*matrices: NDArray[Any]) -> NDArray[np.intp]:
    """Where the entries of each row begin, and end, that are not zero in all of these matrices, (n, 2)."""
    rows, columns = matrices[0].shape
    found, some = np.zeros((rows, 2), dtype=np.intp), np.zeros((rows, columns), dtype=bool)
    for matrix in matrices:
        some |= matrix != 0.0
    any_of = some.any(axis=1)
    if columns > 0:
        found[:, 0], found[:, 1] = some.argmax(axis=1), columns - some[:, ::-1].argmax(axis=1)
    found[~any_of] = 0
    return found


def _tangents(scene: Scene) -> dict[str, Any]:
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is None:
        raise ValueError(f"scene: {scene.name!r} has no friction")
    fields = _contacts(scene, None) | {"restitution": np.zeros(scene.n_c), "offset": np.zeros(scene.n_c)}
    motion = np.zeros((scene.n_c, 3))
    if callable(friction.tangent):
        slip = friction.slip if callable(friction.slip) else ABSENT
        fields |= {"flat": False, "jacobian": friction.tangent, "gap_t": slip}
        fields["G"] = np.zeros((scene.n_c, scene.n_q))
    else:
        G = dense("friction.tangent", friction.tangent)
        fields |= {"G": G, "G_ends": ends(G)}
        if isinstance(friction.slip, Harmonic):
            fields |= {"motion": swaying, "p": sway(friction.slip, scene.n_c)}
        else:
            motion[:, 1] = -np.asarray(friction.slip)
    return fields | {"motion_now": motion}


def _joints(scene: Scene) -> dict[str, Any]:
    return _contacts(scene, None if scene.joints is None else scene.joints.as_contacts())


def _contacts(scene: Scene, contacts: LinearContacts | Contacts | None) -> dict[str, Any]:
    n_c = 0 if contacts is None else contacts.n_c
    if contacts is None:
        fields = _rows(0) | {"G": np.zeros((0, scene.n_q))}
    elif isinstance(contacts, LinearContacts):
        fields = _known(contacts, _flat_rows, scene)
    else:
        fields = _known(contacts, _curved_rows, scene) | {"G": np.zeros((n_c, scene.n_q))}
    return fields | {"motion_now": np.zeros((n_c, 3))}


def _rows(n_c: int) -> dict[str, Any]:
    fields: dict[str, Any] = dict.fromkeys(("motion", "gap", "jacobian", "gap_t", "bias"), ABSENT)
    none = np.zeros((n_c, 2), dtype=np.intp)
    return fields | {"flat": True, "offset": np.zeros(n_c), "restitution": np.zeros(n_c), "G_ends": none}


def _flat_rows(contacts: LinearContacts) -> dict[str, Any]:
    G = dense("G", contacts.G)
    return _rows(contacts.n_c) | {
        "G": G,
        "G_ends": ends(G),
        "offset": np.array(contacts.offset),
        "restitution": np.array(contacts.restitution),
        "motion": contacts.motion or ABSENT,
    }


def _curved_rows(contacts: Contacts) -> dict[str, Any]:
    return _rows(contacts.n_c) | {
        "flat": False,
        "restitution": np.array(contacts.restitution),
        "gap": contacts.gap,
        "jacobian": contacts.jacobian,
        "gap_t": contacts.gap_t or ABSENT,
        "bias": contacts.bias or ABSENT,
    }
