"""Whether two contacts of a finished run slide that share a normal, but not the direction of their friction.

    N_c ~ N_d,    g_c = g_d,    rank (N_c, T_c, T_d) = 3

Friction acts along one direction a contact. Two of them at one place hold what sticks in both directions of a surface
in space, whatever load each has; as soon as one slides, friction is in proportion to its load, which no law shares
out, and no circle of friction comes of it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lagrangian import LinearContacts, Scene
from lcpstep.callbacks.faults import cause, forget
from lcpstep.doubts.depth import spread
from lcpstep.model import looked_at
from lcpstep.trajectory import Trajectory

if TYPE_CHECKING:
    from lcpstep.kernels.model import Model

Array = NDArray[np.float64]
LOOKS = 32  # kept states at which sliding velocities are looked at
PLACES = 3  # of these, at which normals that are functions are compared
SAME = 1e-12  # of a normal's squared size: what another one has across it
ALIKE = 1e-6  # of a tangent's size: what it has beside the normal and another tangent
SLIDES = 5e-2  # of the terms of sliding velocities: steps leave less of what sticks
AT_REST = 1e-9  # of the speed that forces would give: velocities of what rests are nothing but rounding


def slide_on_one(run: Trajectory) -> str:
    """Which contacts do, and when, in words; "" where none was seen."""
    contacts: Any = run.scene.contacts
    if contacts is None or contacts.friction is None or contacts.n_c < 2 or len(run.t) < 2:
        return ""
    if getattr(contacts, "sparse", False):
        return ""
    looked = spread(1, len(run.t) - 1, LOOKS)
    places = looked[:1] if isinstance(contacts, LinearContacts) else looked[:: max(1, len(looked) // PLACES)]
    m = looked_at(run.scene)
    near = {int(k): _near(m, float(run.t[k]), run.q[k].copy()) for k in places}
    cause()  # a callback that fails at a state which the run has not asked it for
    forget()
    try:
        pairs = {x for k in near for x in _rough(run.scene, near[k], *_state(run, k))}
        least = _of_rest(run) if pairs else 0.0
        for k in looked if pairs else ():
            for c, d in sorted(pairs):
                loaded = run.impulse[k, c] + run.impulse[k, d] > 0.0
                if loaded and _slides(run.scene, _state(run, k), c, d, least):
                    return (
                        f"contacts {c} and {d} share their normal, and not their tangents, and slide at t = "
                        f"{run.t[k]:.9g} s: no law says which of them carries the load, so that their friction is "
                        "one of many; it acts along one direction a contact"
                    )
    except ValueError:  # the same
        return ""
    return ""


def _state(run: Trajectory, k: int) -> tuple[float, Array, Array]:
    """Time, coordinates and velocities of a kept state."""
    return float(run.t[k]), run.q[k].copy(), run.v[k].copy()


def _of_rest(run: Trajectory) -> float:
    """The velocity of a coordinate that is none."""
    from lcpstep.errorbar.distance import fall

    return AT_REST * fall(looked_at(run.scene), run)


def _near(m: Model, t: float, q: Array) -> list[tuple[int, int, Array]]:
    """Contacts at one place with one normal, and that."""
    from lcpstep.kernels.states import gaps_at, gradients_at

    at, here = np.array([t]), q[None]
    N = np.asarray(gradients_at(m, at, here)[0])
    sizes = np.einsum("ij,ij->i", N, N)
    both = sizes[:, None] * sizes
    alike = (both - np.maximum(N @ N.T, 0.0) ** 2 <= SAME * both) & (both > 0.0)
    first, second = np.nonzero(alike)
    pairs = first < second
    if not np.any(pairs):
        return []
    c, d = first[pairs], second[pairs]
    g = np.asarray(gaps_at(m, at, here)[0]) / np.sqrt(np.maximum(sizes, np.finfo(float).tiny))
    scale = 1e-8 * max(1.0, float(np.max(np.abs(q))))
    close = np.abs(g[c] - g[d]) <= scale
    return [(i, j, N[i]) for i, j in zip(c[close].tolist(), d[close].tolist(), strict=True)]


def _rough(
    scene: Scene, near: list[tuple[int, int, Array]], t: float, q: Array, v: Array
) -> list[tuple[int, int]]:
    """Those of these pairs that rub along more than one direction."""
    if not near:
        return []
    friction: Any = scene.contacts.friction if scene.contacts is not None else None
    T = np.asarray(friction.tangents((t, q, v, np.array(scene.p)), scene.n_c))
    rough = np.full(scene.n_c, True) if callable(friction.mu) else np.asarray(friction.mu) > 0.0
    return [(c, d) for c, d, N in near if rough[c] and rough[d] and _differ(N, T[c], T[d])]


def _differ(N: Array, T: Array, other: Array) -> bool:
    """Whether two tangents are more than one direction beside the normal."""
    n = N / np.linalg.norm(N)
    one, two = T - (T @ n) * n, other - (other @ n) * n
    sizes = np.linalg.norm(one) * np.linalg.norm(two)
    return bool(sizes > 0.0 and abs(one @ two) < (1.0 - ALIKE) * sizes)


def _slides(scene: Scene, at: tuple[float, Array, Array], c: int, d: int, least: float) -> bool:
    """Whether one of the two has a sliding velocity, where coordinates have more than this."""
    contacts, p = scene.contacts, np.array(scene.p)
    assert contacts is not None
    assert contacts.friction is not None
    u = contacts.friction.sliding(*at, p, contacts.n_c)
    T = np.asarray(contacts.friction.tangents((*at, p), contacts.n_c))
    terms = np.abs(T) @ np.maximum(np.abs(at[2]), least / SLIDES) + np.abs(u - T @ at[2])
    return bool(max(abs(u[c]), abs(u[d])) > SLIDES * max(terms[c], terms[d]))
