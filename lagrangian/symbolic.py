"""Mechanisms from their Lagrangian: L(t, q, v), dissipation and gaps as sympy expressions, derived and compiled.

Lagrange's equations of the second kind with Rayleigh's dissipation function D and generalised forces Q,

    d/dt (dL/dv) - dL/dq + dD/dv = Q + G^T lambda,      L = v^T M v / 2 + b^T v + L_0,

written as M v' + N = F + G^T lambda, that is M v' = f + G^T lambda with f = F - N; indices are derivatives:

    N = (M v + b)_q v + M_t v - (v^T M v / 2 + b^T v)_q,      F = (L_0)_q - b_t - D_v + Q
    G = g_q,      g_t = partial g / partial t,      bias = v^T g_qq v + 2 g_qt v + g_tt

Source: E. T. Whittaker, A Treatise on the Analytical Dynamics of Particles and Rigid Bodies (4th ed., Cambridge
1937), chapters II, III (integral of energy) and VIII (dissipation function).

Needs sympy: pip install "lcpstep[symbolic]".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts
from lagrangian.derived import load
from lagrangian.pickling import Pickled
from lagrangian.scene import Scene
from lagrangian.system import System

try:
    import sympy
    from sympy import Derivative, Expr, ImmutableMatrix, Symbol
    from sympy.core.function import AppliedUndef
    from sympy.printing.pycode import PythonCodePrinter
except ImportError as error:
    raise ImportError('lagrangian.symbolic needs sympy: pip install "lcpstep[symbolic]"') from error

SAMPLES = 8  # random states at which the mass matrix is looked at
SINGULAR = 1e-13  # lowest eigenvalue of a mass matrix scaled to ones on its diagonal


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations of a mechanism in its author's symbols: M v' + N = F + G^T lambda, gaps g >= 0.

    M : (n_q, n_q)   mass matrix
    N : (n_q, 1)   gyroscopic and Coriolis terms: what the Lagrangian gives beyond its value at v = 0
    F : (n_q, 1)   all other forces
    force, force_q, force_v : f = F - N and its Jacobians df/dq, df/dv
    gap, jacobian, gap_t, bias : g, G = dg/dq, partial g / partial t, and (dG/dt) v + d(g_t)/dt; one row a gap
    energy : (1, 1)   Jacobi's integral v dL/dv - L, the energy where nothing moves by prescription
    """

    M: ImmutableMatrix
    N: ImmutableMatrix
    F: ImmutableMatrix
    force: ImmutableMatrix
    force_q: ImmutableMatrix
    force_v: ImmutableMatrix
    gap: ImmutableMatrix
    jacobian: ImmutableMatrix
    gap_t: ImmutableMatrix
    bias: ImmutableMatrix
    energy: ImmutableMatrix

    def each(self, change: Callable[[Expr], Expr]) -> Equations:
        """The same with every expression changed."""
        return Equations(
            **{field.name: getattr(self, field.name).applyfunc(change) for field in fields(self)}
        )


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
        options = {"name": self.name} | options
        return Scene(
            self.system, q0, v0, t_span, self.contacts, parameters=self._values(parameters), **options
        )

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
        changes = _parameters(changed or {})
        if unknown := sorted(changes.keys() - self.parameters.keys()):
            raise ValueError(
                f"parameters: unknown {', '.join(unknown)}; known are {', '.join(self.parameters)}"
            )
        return {**self.parameters, **changes}


def derive(
    lagrangian: Expr,
    coordinates: Expr | Sequence[Expr],
    *,
    velocities: Expr | Sequence[Expr] | None = None,
    parameters: Mapping[Any, float] | None = None,
    dissipation: Expr | float = 0,
    forces: Sequence[Expr] | Mapping[Expr, Expr] | None = None,
    gaps: Expr | Sequence[Expr] = (),
    restitution: ArrayLike = 0.0,
    name: str = "mechanism",
) -> Mechanism:
    """Equations of motion and contacts of a mechanism from its Lagrangian.

    Expressions may contain the coordinates, their velocities, the time, and the parameters.

    Parameters
    ----------
    lagrangian : L = T - V [J], quadratic in the velocities, with a positive definite mass matrix
    coordinates : functions of time, as `dynamicsymbols` makes them (their velocities are q.diff(t), and t is
        their argument); or plain symbols, with `velocities` (the time is then the symbol t)
    velocities : symbols that stand for the coordinates' time derivatives
    parameters : names (or symbols) and values of every other symbol; symbols are told apart by name alone
    dissipation : Rayleigh's function D [W], which puts the force -dD/dv on each coordinate
    forces : generalised forces Q, one a coordinate, or a mapping {coordinate: force}
    gaps : gap functions g(t, q) >= 0 [m], free of velocities
    restitution : (n_c,) or one number for all gaps, 0 <= r <= 1
    name : a short name, for reports

    Returns
    -------
    Mechanism; `mechanism.scene(q0, v0, t_span)` is what `lcpstep.simulate` takes

    Raises
    ------
    ValueError   an expression has unknown symbols or is not real, the Lagrangian is not quadratic in the
        velocities or its mass matrix not positive definite, or a number of entries does not fit; the message
        names the argument

    Notes
    -----
    Where an expression jumps (sign, Heaviside, Piecewise), derivatives are those on either side of the jump.

    Examples
    --------
    >>> from sympy import cos, symbols
    >>> from sympy.physics.mechanics import dynamicsymbols
    >>> theta, (m, g, l) = dynamicsymbols("theta"), symbols("m g l")
    >>> L = m * l**2 * theta.diff() ** 2 / 2 + m * g * l * cos(theta)
    >>> pendulum = derive(L, theta, parameters={"m": 1.0, "g": 9.81, "l": 0.5})
    >>> pendulum.equations.M
    Matrix([[l**2*m]])
    """
    values = _parameters(parameters or {})
    variables = _Variables.of(_sequence(coordinates), velocities, values)
    L = variables.read("lagrangian", lagrangian)
    D = variables.read("dissipation", dissipation)
    Q = _generalised_forces(forces, variables)
    g = [variables.read(f"gaps[{i}]", gap, variables.v) for i, gap in enumerate(_sequence(gaps))]
    return made(_equations(L, D, Q, g, variables), g, variables, values, restitution, name)


def from_sympy(
    method: Any,
    *,
    parameters: Mapping[Any, float] | None = None,
    gaps: Expr | Sequence[Expr] = (),
    restitution: ArrayLike = 0.0,
    name: str = "mechanism",
) -> Mechanism:
    """A mechanism from SymPy's own mechanics: its equations, with gaps.

    Parameters
    ----------
    method : sympy.physics.mechanics.System, KanesMethod or LagrangesMethod whose equations are formed, in independent
        coordinates and speeds; speeds may be any that the kinematic equations give
    parameters, gaps, restitution, name : as of `derive`; gaps in the method's coordinates

    Returns
    -------
    Mechanism, whose velocities are the derivatives of the coordinates; its energy is not known

    Raises
    ------
    ValueError   method is none of these, or has dependent coordinates or speeds; a symbol has no value
    """
    from lagrangian import from_sympy as reader

    return reader.from_sympy(method, parameters=parameters, gaps=gaps, restitution=restitution, name=name)


def made(
    equations: Equations,
    g: list[Expr],
    variables: _Variables,
    values: dict[str, float],
    restitution: ArrayLike,
    name: str,
) -> Mechanism:
    """The mechanism of these equations, in q, v, t, p: their source, loaded and tried."""
    source = _source(equations)
    module = load(source)
    _check_mass(equations.M, module.mass, variables, values)
    return Mechanism(
        system=_system(equations.M, module),
        contacts=_contacts(g, equations, module, restitution),
        parameters=values,
        equations=equations.each(variables.written),
        source=source,
        name=name,
        _energy=getattr(module, "energy", None),
    )


# --- the author's symbols


@dataclass(frozen=True)
class _Variables:
    """The author's symbols, and the real ones that callbacks are written in: q[0], v[0], p[0], t."""

    coordinates: tuple[Expr, ...]
    q: tuple[Symbol, ...]
    v: tuple[Symbol, ...]
    t: Symbol
    named: dict[str, Symbol]  # plain symbols, by name
    functions: dict[Expr, Symbol]  # functions of time and their derivatives
    outward: dict[Symbol, Expr]  # as the author writes them, with the assumptions met in what was read

    @classmethod
    def of(cls, coordinates: list[Any], velocities: Any, parameters: Iterable[str]) -> _Variables:
        """Give everything that an expression may contain its place."""
        time, names = _time(coordinates), list(parameters)
        rates = _velocities(coordinates, velocities, time)
        q, v, p = (_places(*x) for x in (("q", len(coordinates)), ("v", len(rates)), ("p", len(names))))
        t = Symbol("t", real=True)
        authors = [*coordinates, *rates, *map(Symbol, names), time]
        if twice := sorted({str(x) for x in authors if [*map(str, authors)].count(str(x)) > 1}):
            raise ValueError(f"coordinates, velocities, parameters, time: {', '.join(twice)} given twice")
        inward = dict(zip(authors, [*q, *v, *p, t], strict=True))
        functions = {
            x.diff(time): y for x, y in zip(coordinates, v, strict=True) if isinstance(x, AppliedUndef)
        }
        functions |= {x: y for x, y in inward.items() if not isinstance(x, Symbol)}
        named = {x.name: y for x, y in inward.items() if isinstance(x, Symbol)}
        return cls(tuple(coordinates), q, v, t, named, functions, {y: x for x, y in inward.items()})

    def read(self, name: str, value: Any, without: Iterable[Symbol] = ()) -> Expr:
        """An expression of the author's in q, v, t, p; an error that names the argument if it is none."""
        expression = _expression(name, value).doit()
        symbols = expression.free_symbols
        parts = expression.atoms(AppliedUndef, Derivative)
        unknown = [x for x in symbols if x.name not in self.named] + [
            x for x in parts if x not in self.functions
        ]
        if unknown:
            raise ValueError(
                f"{name}: unknown {', '.join(sorted(map(str, unknown)))}; expected an expression in the "
                f"coordinates, their first derivatives, the time and the parameters"
            )
        plain = {x: self.named[x.name] for x in symbols}
        self.outward.update({y: x for x, y in plain.items()})
        result = _steps(expression.xreplace(self.functions | plain))
        if result.is_real is False or result.has(sympy.I, sympy.zoo, sympy.oo, -sympy.oo, sympy.nan):
            raise ValueError(f"{name}: expected a real, finite expression, got {expression}")
        if present := result.free_symbols & set(without):
            raise ValueError(f"{name}: expected no velocities, got {self.names(present)}")
        _printed(name, result)
        return result

    def written(self, expression: Expr) -> Expr:
        """An expression in q, v, t, p in the author's symbols."""
        return expression.xreplace(self.outward)

    def names(self, symbols: Iterable[Symbol]) -> str:
        """What the author calls them."""
        return ", ".join(sorted(str(self.outward[x]) for x in symbols))


def _time(coordinates: list[Any]) -> Symbol:
    """The symbol of time: the argument of the coordinates that are functions, otherwise t."""
    if not coordinates or not all(isinstance(q, Symbol | AppliedUndef) for q in coordinates):
        raise ValueError(f"coordinates: expected symbols or functions of time, got {coordinates}")
    times = {q.args for q in coordinates if isinstance(q, AppliedUndef)} or {(Symbol("t"),)}
    time = next(iter(times))
    if len(times) > 1 or len(time) > 1 or not isinstance(time[0], Symbol):
        raise ValueError(f"coordinates: expected functions of one and the same time, got {coordinates}")
    return time[0]


def _velocities(coordinates: list[Any], velocities: Any, time: Symbol) -> list[Any]:
    """The symbols of the velocities: those given, or the derivatives of the coordinates."""
    rates = [q.diff(time) if isinstance(q, AppliedUndef) else None for q in coordinates]
    if velocities is None and None in rates:
        raise ValueError("velocities: expected one symbol for each coordinate, as these are plain symbols")
    given = rates if velocities is None else _sequence(velocities)
    if len(given) != len(rates):
        raise ValueError(f"velocities: expected {len(rates)}, one for each coordinate, got {len(given)}")
    for x, rate in zip(given, rates, strict=True):
        if x != rate and not isinstance(x, Symbol | AppliedUndef):
            raise ValueError(f"velocities: expected symbols, in the order of the coordinates, got {x!r}")
    return given


def _places(letter: str, n: int) -> tuple[Symbol, ...]:
    return tuple(Symbol(f"{letter}[{i}]", real=True) for i in range(n))


def _sequence(value: Any) -> list[Any]:
    """One expression, or several in a list, tuple, or matrix."""
    return list(value) if np.iterable(value) and not isinstance(value, str) else [value]


def _expression(name: str, value: Any) -> Expr:
    try:
        result = sympy.sympify(value, strict=True)
    except (sympy.SympifyError, TypeError):
        result = None
    if not isinstance(result, Expr) or result.is_Matrix:
        raise ValueError(f"{name}: expected a sympy expression, got {value!r}")
    return result


def _parameters(given: Mapping[Any, float]) -> dict[str, float]:
    if not isinstance(given, Mapping):
        raise ValueError(f"parameters: expected a mapping from names to numbers, got {given!r}")
    return {str(x): checks.number(f"parameters[{str(x)!r}]", value) for x, value in given.items()}


def _generalised_forces(forces: Any, variables: _Variables) -> list[Expr]:
    n_q = len(variables.q)
    if forces is None:
        return [sympy.S.Zero] * n_q
    if isinstance(forces, Mapping):
        if strange := [str(x) for x in forces if x not in variables.coordinates]:
            raise ValueError(
                f"forces: {', '.join(strange)} is no coordinate; these are {variables.coordinates}"
            )
        forces = [forces.get(x, 0) for x in variables.coordinates]
    forces = _sequence(forces)
    if len(forces) != n_q:
        raise ValueError(f"forces: expected {n_q}, one a coordinate, got {len(forces)}")
    return [variables.read(f"forces[{i}]", force) for i, force in enumerate(forces)]


# --- the equations


def _equations(L: Expr, D: Expr, Q: list[Expr], g: list[Expr], x: _Variables) -> Equations:
    """Lagrange's equations and the gaps' derivatives, in q, v, t, p."""
    M, b, L_0 = _collected(L, x)
    v = ImmutableMatrix(x.v)
    momentum, moving = M * v + b, v.T * M * v / 2 + b.T * v
    N = _jacobian(momentum, x.q) * v + (M * v).diff(x.t) - _jacobian(moving, x.q).T
    F = _jacobian([L_0], x.q).T - b.diff(x.t) - _jacobian([D], x.v).T + ImmutableMatrix(Q)
    gap, G = ImmutableMatrix(len(g), 1, g), _jacobian(g, x.q)
    gap_t = gap.diff(x.t)
    u = G * v + gap_t
    found = Equations(
        M=M,
        N=N,
        F=F,
        force=F - N,
        force_q=_jacobian(F - N, x.q),
        force_v=_jacobian(F - N, x.v),
        gap=gap,
        jacobian=G,
        gap_t=gap_t,
        bias=_jacobian(u, x.q) * v + u.diff(x.t),
        energy=v.T * M * v / 2 - ImmutableMatrix([L_0]),
    )
    return found.each(_beside_jumps)


def _collected(L: Expr, x: _Variables) -> tuple[ImmutableMatrix, ImmutableMatrix, Expr]:
    """M, b, L_0 of L = v^T M v / 2 + b^T v + L_0; every coordinate must have inertia."""
    rates = set(x.v)
    momentum = _jacobian([L], x.v).T
    M = _jacobian(momentum, x.v).applyfunc(_tidy)
    if M.free_symbols & rates:
        M = M.applyfunc(sympy.simplify)
    if present := M.free_symbols & rates:
        raise ValueError(
            f"lagrangian: expected one quadratic in the velocities, but its second derivatives by them "
            f"depend on {x.names(present)}"
        )
    if massless := [str(q) for i, q in enumerate(x.coordinates) if not any(M.row(i))]:
        raise ValueError(f"lagrangian: singular mass matrix: no kinetic energy in {', '.join(massless)}")
    n, at_rest = len(x.q), dict.fromkeys(x.v, sympy.S.Zero)
    symmetric = ImmutableMatrix(n, n, lambda i, j: M[min(i, j), max(i, j)])
    return symmetric, momentum.xreplace(at_rest).applyfunc(_tidy), _tidy(L.xreplace(at_rest))


def _tidy(expression: Expr) -> Expr:
    """Without the squares of sines and cosines that velocities in Cartesian coordinates leave."""
    if not expression.has(sympy.sin, sympy.cos):
        return expression
    return min(expression, sympy.trigsimp(sympy.expand(expression)), key=sympy.count_ops)


def _jacobian(rows: Iterable[Expr], x: Sequence[Symbol]) -> ImmutableMatrix:
    """Matrix of the derivatives of each row by each symbol."""
    listed = list(rows)
    return ImmutableMatrix(len(listed), len(x), [row.diff(y) for row in listed for y in x])


def _beside_jumps(expression: Expr) -> Expr:
    """Derivatives on either side of a jump: without the impulse at it."""
    return _steps(expression.replace(sympy.DiracDelta, lambda *_: sympy.S.Zero))


def _steps(expression: Expr) -> Expr:
    """Heaviside's step by the sign, which Python can write."""
    return expression.replace(sympy.Heaviside, lambda y, *_: (1 + sympy.sign(y)) / 2)


def _check_mass(M: ImmutableMatrix, mass: Callback, x: _Variables, values: Mapping[str, float]) -> None:
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


# --- from expressions to callbacks


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


def _source(found: Equations) -> str:
    """Python source of all callbacks."""
    vectors = {name: getattr(found, name) for name in ("force", "gap", "gap_t", "bias", "energy")}
    matrices = {"mass": found.M} | {name: getattr(found, name) for name in ("force_q", "force_v", "jacobian")}
    targets = [(name, x, [f"out[{i}]" for i in range(x.rows)]) for name, x in vectors.items()]
    targets += [
        (name, x, [f"out[{i}, {j}]" for i in range(x.rows) for j in range(x.cols)])
        for name, x in matrices.items()
    ]
    functions = [_function(name, list(x), places) for name, x, places in targets if places]
    return "\n\n".join(['"""Derived by lagrangian.symbolic."""\n\nimport math\n', *functions])


def _function(name: str, expressions: list[Expr], places: list[str]) -> str:
    """Source of one callback; what its expressions share is computed once."""
    origin = "gaps" if name in ("gap", "jacobian", "gap_t", "bias") else "lagrangian, dissipation, forces"
    label = f"{origin}: {name}"
    shared: list[tuple[Symbol, Expr]] = []
    if not any(e.has(sympy.Piecewise) for e in expressions):  # whose cases must not be computed outside them
        shared, expressions = sympy.cse(expressions, sympy.numbered_symbols("a", real=True))
    lines = [f"{x} = {_printed(label, e)}" for x, e in shared]
    lines += [f"{place} = {_printed(label, e)}" for place, e in zip(places, expressions, strict=True)]
    body = "".join(f"    {line}\n" for line in lines)
    return f"def {name}(t, q, v, p, out):\n{body}"


def _printed(name: str, expression: Expr) -> str:
    """The expression as Python; an error where Python's math knows no such function."""
    printer = PythonCodePrinter({"fully_qualified_modules": True})
    try:
        text = str(printer.doprint(expression))
    except (NotImplementedError, ValueError):  # no such function; the derivative of one that has none
        text = "None"
    # "None" stands where a Piecewise has no last case, "Not supported" for unknown functions
    if "None" in text or "Not supported" in text or printer.module_imports.keys() - {"math"}:
        raise ValueError(f"{name}: cannot be written with Python's math functions alone: {expression}")
    return text
