"""Piecewise-smooth systems with a discrete state: x' = f_mode(t, x), guards, resets, switching surfaces.

A *guard* leaves its mode where its function rises through zero (or falls), for a target mode, with a reset of the
state or without. A *surface* H(t, x) = 0 parts two modes, F1 below (H < 0) and F2 above. Where both fields point
at it the motion slides on it, by Filippov's convex combination

    F_s = (L2 F1 - L1 F2) / (L2 - L1),      L_i = H_t + H_x F_i,      L1 > 0 > L2

until L1 or L2 vanishes; where both point the same way it passes through. Source: A. F. Filippov, Differential
Equations with Discontinuous Righthand Sides (Kluwer 1988), chapter 2; G. Osorio, Complex Behavior in Impacting
Systems, section 2.14; T. Henzinger, The theory of hybrid automata (LICS 1996) for guards and resets.

Functions of the user have the signature f(t, x, p, out): they fill `out` from the time t, the state x (n_x,) and the
parameters p (n_p,).

A map of states, x -> P(x), needs the mode that belongs to a state. Surfaces that part all modes tell it; other
systems have a function `mode_of`, and one that remembers (a relay with hysteresis) keeps what it remembers as a state
whose rate is zero, set by resets.

A mechanical system, x = (q, v) with a mass matrix M(t, q), may have contacts in all its modes:

    q' = v,    M v' = M a_mode(t, q, v) + G^T lambda,    0 <= g(t, q)  complementary to  lambda >= 0,    u+ = -r u-
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.mechanical import check_contacts, check_rates, mass_of
from lagrangian.modes import Function, Guard, Mode, Surface
from lagrangian.parameters import in_words, plain, values
from lagrangian.pickling import Pickled
from lagrangian.plain import in_order

ModeOf = Callable[[float, Any, Any], str]  # mode(t, x, p), its name


@dataclass(frozen=True, eq=False)
class HybridSystem:
    """Modes, and the surfaces between them.

    Parameters
    ----------
    n_x : number of states
    modes : modes by name
    surfaces : switching surfaces; sliding on two of them at once is not described
    mode_of : function mode(t, x, p) giving the name of the mode that a motion through a state is in, in plain Python;
        Poincare maps need it, but where the modes are those of one surface, which tells them
    mass : (n_q, n_q) matrix, callback f(t, q, v, p, out) filling out (n_q, n_q), or None
        Mass matrix of a mechanical system, whose states are (q, v) and whose fields give (v, v'); contacts need it.

    Raises
    ------
    ValueError   a name is unknown or used twice, or something is no function
    """

    n_x: int
    modes: Mapping[str, Mode]
    surfaces: Sequence[Surface] = ()
    mode_of: ModeOf | None = None
    mass: Callback | ArrayLike | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "n_x", checks.count("n_x", self.n_x))
        object.__setattr__(self, "mass", mass_of(self.n_x, self.mass))
        if self.mode_of is not None and not callable(self.mode_of):
            raise ValueError(f"mode_of: expected a function mode(t, x, p), got {self.mode_of!r}")
        if not isinstance(self.modes, Mapping):
            raise TypeError(f"modes: expected modes by name, got {self.modes!r}")
        for name, mode in self.modes.items():
            checks.instance(f"modes: {name}", mode, Mode)
        object.__setattr__(self, "modes", dict(self.modes))
        object.__setattr__(self, "surfaces", tuple(self.surfaces))
        if not self.modes:
            raise ValueError("modes: expected at least one mode")
        names = self.names
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"surfaces: {name!r} names two modes; give each its own `sliding`")
        for mode in self.modes.values():
            self._check_targets(mode.guards)
        for surface in self.surfaces:
            self._check_targets(surface.guards)
            for side in (surface.below, surface.above):
                if side not in self.modes:
                    raise ValueError(f"surface: unknown mode {side!r}; known: {', '.join(self.modes)}")

    def _check_targets(self, guards: Sequence[Guard]) -> None:
        for guard in guards:
            if guard.target not in self.names:
                raise ValueError(
                    f"guard.target: unknown mode {guard.target!r}; known: {', '.join(self.names)}"
                )

    @property
    def names(self) -> list[str]:
        """Names of all modes, those of sliding last."""
        return [*self.modes, *(surface.sliding for surface in self.surfaces)]

    @property
    def tells_modes(self) -> bool:
        """Whether a state alone tells its mode: by `mode_of`, or by the one surface that parts all modes."""
        return self.mode_of is not None or (len(self.surfaces) == 1 and len(self.modes) == 2)

    def named_mode(self, t: float, x: Array, p: Array) -> str:
        """The mode that `mode_of` gives, checked."""
        assert self.mode_of is not None
        name = self.mode_of(t, x, p)
        if name not in self.names:
            raise ValueError(
                f"mode_of: expected one of {', '.join(self.names)} at t = {t:g}, x = {checks.shown(x)}, "
                f"got {name!r}"
            )
        return name

    def trial(self, t: float, x: Array, p: Array) -> None:
        """Evaluate every function once; raises ValueError where one does not fill its `out`."""
        at = (t, x, p)
        if self.mode_of is not None:
            self.named_mode(*at)
        for name, mode in self.modes.items():
            rates = evaluate(f"field of mode {name!r}", mode.field, at, self.n_x)
            if self.mass is not None:
                check_rates(name, rates, x)
        for name, guards in self.guards().items():
            for guard in guards:
                evaluate(f"guard of mode {name!r}", guard.value, at, 1)
                if guard.reset is not None:
                    evaluate(f"reset of a guard of mode {name!r}", guard.reset, at, self.n_x)
        for surface in self.surfaces:
            evaluate(f"surface of {surface.sliding!r}", surface.value, at, 1)

    def guards(self) -> dict[str, Sequence[Guard]]:
        """The guards of every mode that the user gave, the sliding ones included."""
        plain = {name: mode.guards for name, mode in self.modes.items()}
        return plain | {surface.sliding: surface.guards for surface in self.surfaces}


@dataclass(frozen=True, eq=False)
class HybridScene(Pickled):
    """A system with modes, its initial state and mode, and a time span.

    Parameters
    ----------
    system : HybridSystem
    x0 : (n_x,)   state at the start
    mode : name of the mode at the start
    t_span : (t_start, t_end)
    p : (n_p,)   parameters handed to every function; the values of `parameters` where not given
    parameters : names and values of the scene's parameters, for reports
    period : period of what depends on time, math.inf where nothing does; guards are looked at 16 times in it at least
    name : a short name, for reports
    exact : function of times (m,) giving x (m, n_x), the motion where it is known in closed form, or None
    labels : name of each state with its unit, for axes: ("position [m]", ...); x1, x2, .. where not given
    drawing : function (t, x) -> shapes of `lagrangian.drawing`, or None
    contacts : LinearContacts, Contacts, or None   of all modes, as of a `Scene`: callbacks are f(t, q, v, p, out);
        the system needs its `mass` for them

    Raises
    ------
    ValueError   a shape does not fit, a function fails, or the mode is unknown; the message names the argument
    """

    system: HybridSystem
    x0: ArrayLike
    mode: str
    t_span: tuple[float, float]
    p: ArrayLike | None = None
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    period: float = math.inf
    name: str = "hybrid scene"
    exact: Callable[[Array], Array] | None = None
    labels: Sequence[str] = ()
    drawing: Callable[[float, Any], Any] | None = None
    contacts: LinearContacts | Contacts | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.system, HybridSystem):
            raise TypeError(f"system: expected a lagrangian.HybridSystem, got {self.system!r}")
        object.__setattr__(self, "parameters", plain(self.parameters))
        p = values(self.p, self.parameters)
        object.__setattr__(self, "x0", checks.array("x0", self.x0, (self.system.n_x,)))
        object.__setattr__(self, "p", p)
        if self.mode not in self.system.names:
            raise ValueError(f"mode: unknown mode {self.mode!r}; known: {', '.join(self.system.names)}")
        span = checks.array("t_span", self.t_span, (2,))
        if not span[0] < span[1]:
            raise ValueError(f"t_span: expected t_start < t_end, got {self.t_span!r}")
        object.__setattr__(self, "t_span", (float(span[0]), float(span[1])))
        object.__setattr__(self, "period", checks.period(self.period))
        labels = tuple(self.labels) or tuple(f"x{k + 1}" for k in range(self.n_x))
        if len(labels) != self.n_x or not all(isinstance(x, str) for x in labels):
            raise ValueError(f"labels: expected {self.n_x} names of states, got {self.labels!r}")
        object.__setattr__(self, "labels", labels)
        self.system.trial(self.t_span[0], np.array(self.x0), np.array(self.p))
        if self.contacts is not None:
            check_contacts(self)

    def __repr__(self) -> str:
        modes = f"modes {', '.join(self.system.names)}"
        met = [f"{self.n_c} contact{'s' * (self.n_c > 1)}"] if self.n_c else []
        return in_words(self, [f"{self.n_x} states", *met, modes, f"starts in {self.mode}"])

    @property
    def n_x(self) -> int:
        """Number of states."""
        return self.system.n_x

    @property
    def n_c(self) -> int:
        """Number of contacts."""
        return 0 if self.contacts is None else self.contacts.n_c

    @property
    def corners(self) -> Array:
        """Times of corners of the forcing: a system with modes has none, its guards are what is watched."""
        return np.zeros(0)

    def started(self, x0: ArrayLike, mode: str, t_span: tuple[float, float] | None = None) -> HybridScene:
        """The same system from another state and mode; a motion in closed form is dropped."""
        return replace(self, x0=x0, mode=mode, t_span=t_span or self.t_span, exact=None)


def evaluate(name: str, f: Function, at: tuple[float, Array, Array], n: int) -> Array:
    """Value of a user's function in plain Python, (n,); an error if it does not fill `out`."""
    t, x, p = at
    in_order(name, f, ("t", "x", "p", "out"))

    def with_velocities(t: float, q: Array, v: Array, p: Array, out: Array) -> Any:
        return f(t, q, p, out)

    try:
        return checks.evaluate(name, with_velocities, (t, x, x, p), (n,))
    except ValueError as error:
        said, state = str(error), checks.shown(x)
        for of_second_order, own in (
            ("f(t, q, v, p, out)", "f(t, x, p, out)"),
            ("q, v of shape", "x of shape"),
            (f"q = {state}, v = {state}", f"x = {state}"),
            ("q, v and p are not", "x and p are not"),
        ):
            said = said.replace(of_second_order, own)
        raise ValueError(said) from error
