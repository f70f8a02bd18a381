"""What a system with modes needs for contacts: states (q, v), a mass matrix, and no start inside an obstacle.

    q' = v,    M(t, q) v' = M a_mode + G^T lambda

See `hybrid` for the modes, `scene` for what is checked of masses and contacts.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.scene import Scene
from lagrangian.system import System

if TYPE_CHECKING:
    from lagrangian.hybrid import HybridScene


def mass_of(n_x: int, mass: Callback | ArrayLike | None) -> Callback | Array | None:
    """The mass matrix of a system with n_x states, checked."""
    if mass is None:
        return None
    if n_x % 2:
        raise ValueError(f"n_x: expected an even number of states (q, v) where a mass is given, got {n_x}")
    if callable(mass):
        return mass
    return checks.mass_matrix("mass", checks.array("mass", mass, (n_x // 2, n_x // 2)))


def check_rates(name: str, rates: Array, x: Array) -> None:
    """ValueError where the field of a mode does not begin with the velocities."""
    n_q = len(x) // 2
    if not np.array_equal(rates[:n_q], x[n_q:]):
        raise ValueError(
            f"field of mode {name!r}: expected (v, v') at the state (q, v), as `mass` is given; its first {n_q} "
            f"numbers are {checks.shown(rates[:n_q])} where v = {checks.shown(x[n_q:])}"
        )


def check_contacts(scene: HybridScene) -> None:
    """Contacts belong to a system with a mass, which starts outside of obstacles; errors name the argument."""
    checks.instance("contacts", scene.contacts, LinearContacts, Contacts)
    if scene.system.mass is None:
        raise ValueError(
            "contacts: expected a system with a mass matrix, HybridSystem(mass=...), whose states are (q, v); "
            "impulses act through it"
        )
    try:
        mechanics(scene)
    except ValueError as error:
        raise ValueError(str(error).replace("q0: ", "x0: ").replace("system.mass", "mass")) from error


def mechanics(scene: HybridScene) -> Scene:
    """Coordinates, masses and contacts of a scene that has contacts, without modes but the one at the start."""
    n_q, x, modes = scene.n_x // 2, np.asarray(scene.x0), scene.system.modes
    mass: Any = scene.system.mass
    mode = modes.get(scene.mode, next(iter(modes.values())))  # one of sliding has no field of its own
    return Scene(
        system=System(n_q, mass, OfMode(mode.field, mass)), q0=x[:n_q], v0=x[n_q:], t_span=scene.t_span,
        contacts=scene.contacts, p=scene.p, parameters=scene.parameters, period=scene.period, name=scene.name,
        coordinates=scene.labels[:n_q],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class OfMode:
    """The force M a of the field (v, a) of a mode: a callback f(t, q, v, p, out)."""

    field: Callable[[float, Any, Any, Any], Any]
    mass: Callback | ArrayLike

    def __call__(self, t: float, q: Any, v: Any, p: Any, out: Any) -> None:
        """Fill out (n_q,)."""
        n = len(q)
        rates, M = np.zeros(2 * n), np.zeros((n, n))
        self.field(t, np.concatenate([q, v]), p, rates)
        if callable(self.mass):
            self.mass(t, q, v, p, M)
        else:
            M[:] = self.mass
        out[:] = M @ rates[n:]
