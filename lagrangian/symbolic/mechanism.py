"""A mechanism: its equations as expressions, and the system and contacts whose callbacks were written from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from sympy import Expr, ImmutableMatrix

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts
from lagrangian.derived import load
from lagrangian.pickling import Pickled
from lagrangian.scene import Scene
from lagrangian.symbolic.expressions import Equations
from lagrangian.symbolic.source import source_of
from lagrangian.symbolic.variables import Variables, parameter_values
from lagrangian.system import System

SAMPLES = 8  # random states at which the mass matrix is looked at
SINGULAR = 1e-13  # lowest eigenvalue of a mass matrix scaled to ones on its diagonal


@dataclass(frozen=True, eq=False)
class Mechanism(Pickled):
    """What `derive` found: a system and its contacts, ready for scenes.

    system : lagrangian.System, whose callbacks read the parameters from p
    contacts : lagrangian.Contacts, or None without gaps
    parameters : names and values of the parameters, in the order of p
    equations : the same as sympy expressions, to be read or printed
    source : the Python source of the callbacks
    name : a short name, for reports
    """

    system: System
    contacts: Contacts | None
    parameters: Mapping[str, float]
    equations: Equations
    source: str
    name: str
    _energy: Callback | None

    def scene(
        self,
        q0: ArrayLike,
        v0: ArrayLike,
        t_span: tuple[float, float],
        parameters: Mapping[Any, float] | None = None,
        **options: Any,
    ) -> Scene:
        """A scene of this mechanism.

        Parameters
        ----------
        q0, v0 : (n_q,)   initial state, in the order of the coordinates
        t_span : (t_start, t_end) [s]
        parameters : values that differ from those of the mechanism; nothing is derived or compiled again
        options : handed to `lagrangian.Scene` (corners, period, name)

        Raises
        ------
        ValueError   a parameter is unknown, or `Scene` refuses an argument
        """
        named: dict[str, Any] = {"name": self.name} | options
        return Scene(self.system, q0, v0, t_span, self.contacts, parameters=self._values(parameters), **named)

    def energy(
        self, t: ArrayLike, q: ArrayLike, v: ArrayLike, parameters: Mapping[Any, float] | None = None
    ) -> Array:
        """Jacobi's integral v dL/dv - L [J] at states t (m,), q (m, n_q), v (m, n_q); shape (m,).

        It is the energy T + V of a mechanism in whose Lagrangian nothing moves by prescription, and constant
        under no dissipation and no forces Q as long as the Lagrangian does not name the time.
        """
        if self._energy is None:
            raise ValueError(f"energy: not known of {self.name!r}, whose equations came without a Lagrangian")
        times, n_q = np.atleast_1d(np.asarray(t, dtype=float)), self.system.n_q
        states = [checks.array(name, x, (len(times), n_q)) for name, x in {"q": q, "v": v}.items()]
        p, out = np.array(list(self._values(parameters).values())), np.empty((len(times), 1))
        for i, instant in enumerate(times):
            self._energy(instant, states[0][i], states[1][i], p, out[i])
        return out[:, 0]

    def _values(self, changed: Mapping[Any, float] | None) -> dict[str, float]:
        changes = parameter_values(changed or {})
        if unknown := sorted(changes.keys() - self.parameters.keys()):
            raise ValueError(
                f"parameters: unknown {', '.join(unknown)}; known are {', '.join(self.parameters)}"
            )
        return {**self.parameters, **changes}


def made(
    equations: Equations,
    g: list[Expr],
    variables: Variables,
    values: dict[str, float],
    restitution: ArrayLike,
    name: str,
) -> Mechanism:
    """The mechanism of these equations, in q, v, t, p: their source, loaded and tried."""
    source = source_of(equations)
    module = load(source)
    check_mass(equations.M, module.mass, variables, values)
    return Mechanism(
        system=_system(equations.M, module),
        contacts=_contacts(g, equations, module, restitution),
        parameters=values,
        equations=equations.each(variables.written),
        source=source,
        name=name,
        _energy=getattr(module, "energy", None),
    )


def check_mass(M: ImmutableMatrix, mass: Callback, x: Variables, values: Mapping[str, float]) -> None:
    """Refuse a mass matrix that is not positive definite at any of some random states."""
    random, reason = np.random.default_rng(0), None
    for _ in range(SAMPLES):
        t, q, v = random.uniform(0, 1), *random.uniform(-1, 1, (2, len(x.q)))
        try:
            with np.errstate(all="ignore"):
                found = checks.evaluate("mass", mass, (t, q, v, np.array(list(values.values()))), M.shape)
        except (ValueError, ArithmeticError):
            continue  # an expression that does not exist there
        if _definite(found):
            return
        reason = f"at q = {q.tolist()} it is {found.tolist()}"
    if reason:
        written = M.applyfunc(x.written).tolist()
        raise ValueError(f"lagrangian: singular or indefinite mass matrix {written}; {reason}")


def _definite(M: Array) -> bool:
    """Whether a mass matrix is positive definite, whatever the units of its coordinates."""
    inertia = np.diag(M)
    return bool(
        np.all(inertia > 0.0) and np.linalg.eigvalsh(M / np.sqrt(np.outer(inertia, inertia)))[0] > SINGULAR
    )


def _system(M: ImmutableMatrix, module: Any) -> System:
    constant = not M.free_symbols  # a parameter may change without the system
    return System(
        n_q=M.rows,
        mass=np.array(M.tolist(), dtype=float) if constant else module.mass,
        force=module.force,
        force_q=module.force_q,
        force_v=module.force_v,
    )


def _contacts(g: list[Expr], found: Equations, module: Any, restitution: ArrayLike) -> Contacts | None:
    if not g:
        return None
    return Contacts(
        n_c=len(g),
        gap=module.gap,
        jacobian=module.jacobian,
        gap_t=module.gap_t if any(found.gap_t) else None,
        bias=module.bias,
        restitution=restitution,
    )
