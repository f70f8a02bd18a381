"""A scene: a system, its contacts, an initial state and a time span. A question without a method."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.drawing import Drawing
from lagrangian.joints import Joints, LinearJoints
from lagrangian.joints import state as joint_state
from lagrangian.labels import rate_label
from lagrangian.parameters import in_words, plain, values
from lagrangian.pickling import Pickled
from lagrangian.relations import check_derivatives, is_large
from lagrangian.system import Harmonic, LinearSystem, System

ROUNDING = 64 * np.finfo(float).eps  # of a gap evaluated on the obstacle
EXACT_START = 1e-9  # how near a motion in closed form must start to the initial state
JOINT_ROUNDING = 1e-12  # of a joint that the user's own arithmetic has closed


@dataclass(frozen=True, eq=False)
class Scene(Pickled):
    """System, contacts, initial state and time span.

    Parameters
    ----------
    system : LinearSystem or System
    q0, v0 : (n_q,)   state at the start of the span
    t_span : (t_start, t_end) [s]
    contacts : LinearContacts, Contacts, or None for a system that meets nothing
    joints : LinearJoints, Joints, or None   bilateral constraints, which the initial state must satisfy
    p : (n_p,)   parameters handed to every callback; the numbers of `parameters`, in their order, where not given, or
        None, as beside new ones in `dataclasses.replace(scene, parameters=..., p=None)`
    parameters : names and values of the scene's parameters, for reports; read-only
    corners : (m,)   times in [0, period) at which a callback or one of its derivatives jumps [s]
    period : period of the forcing [s], a whole number of turns of a `Harmonic` force; math.inf where nothing repeats
    name : a short name, for reports
    exact : function of times (m,) giving q and v, each (m, n_q), or None
        The motion from q0, v0 where it is known in closed form; v is the right limit at an impact. One that does
        not start from q0, v0 is dropped, as when `dataclasses.replace` gives the scene another initial state; it
        cannot be noticed that the system has changed under it.
    coordinates : (n_q,) names with their units, for axes: ("angle [rad]", ...); lengths where not given
    drawing : function (t, q) -> shapes of `lagrangian.drawing`, what the mechanism looks like; or None

    Raises
    ------
    TypeError   system, contacts or joints are none
    ValueError   a shape does not fit, a callback fails or depends on what it may not, a derivative does not belong to
        its function, the period is not that of the force, or the initial state lies inside an obstacle or off a
        joint; the message names the argument
    """

    system: LinearSystem | System
    q0: ArrayLike
    v0: ArrayLike
    t_span: tuple[float, float]
    contacts: LinearContacts | Contacts | None = None
    joints: LinearJoints | Joints | None = None
    p: ArrayLike | None = None
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    corners: ArrayLike = ()
    period: float = math.inf
    name: str = "scene"
    exact: Callable[[Array], tuple[Array, Array]] | None = None
    coordinates: Sequence[str] = ()
    drawing: Drawing | None = None

    def __post_init__(self) -> None:
        self._check_parts()
        n_q = self.system.n_q
        object.__setattr__(self, "parameters", plain(self.parameters))
        p = values(self.p, self.parameters)
        corners = np.sort(checks.vector("corners", self.corners))
        object.__setattr__(self, "q0", checks.array("q0", self.q0, (n_q,)))
        object.__setattr__(self, "v0", checks.array("v0", self.v0, (n_q,)))
        object.__setattr__(self, "p", p)
        object.__setattr__(self, "corners", checks.array("corners", corners, corners.shape))
        self._check_times()
        object.__setattr__(self, "coordinates", checks.labels("coordinates", self.coordinates, n_q))
        if self.drawing is not None and not callable(self.drawing):
            raise ValueError(f"drawing: expected a function f(t, q) that gives shapes, got {self.drawing!r}")
        at = (self.t_span[0], np.array(self.q0), np.array(self.v0), np.array(self.p))
        self.system.trial(*at)
        if self.contacts is not None:
            self._check_start(*self.contacts.state(*at))
            if self.contacts.friction is not None:
                fixed = isinstance(self.contacts, LinearContacts)
                self.contacts.friction.check_directions(at, self.contacts.normals, fixed)
        if self.joints is not None:
            self._check_joints(*joint_state(self.joints, *at))
        if not is_large(self):
            check_derivatives(self, [at[:3]])
        if self.exact is not None and not self._starts_exact():
            object.__setattr__(self, "exact", None)

    def __repr__(self) -> str:
        parts = [f"{self.n_q} coordinate{'s' * (self.n_q > 1)}"]
        parts += [
            f"{n} {what}{'s' * (n > 1)}" for n, what in ((self.n_c, "contact"), (self.n_j, "joint")) if n
        ]
        return in_words(self, parts)

    @property
    def n_q(self) -> int:
        """Number of coordinates."""
        return self.system.n_q

    @property
    def n_x(self) -> int:
        """Number of states (q, v)."""
        return 2 * self.n_q

    @property
    def x0(self) -> Array:
        """State (q, v) at the start."""
        return np.concatenate([np.asarray(self.q0), np.asarray(self.v0)])

    @property
    def labels(self) -> tuple[str, ...]:
        """Name of each state with its unit, for axes."""
        if self.coordinates:
            return (*self.coordinates, *map(rate_label, self.coordinates))
        if self.n_q == 1:
            return ("position [m]", "velocity [m/s]")
        numbers = range(1, self.n_q + 1)
        return tuple(f"position {k} [m]" for k in numbers) + tuple(f"velocity {k} [m/s]" for k in numbers)

    @property
    def n_c(self) -> int:
        """Number of contacts."""
        return 0 if self.contacts is None else self.contacts.n_c

    @property
    def n_j(self) -> int:
        """Number of joints."""
        return 0 if self.joints is None else self.joints.n_j

    def gap(self, t: float, q: ArrayLike, v: ArrayLike) -> tuple[Array, Array]:
        """Gaps g [m] and gap velocities u [m/s] at a state, each (n_c,)."""
        if self.contacts is None:
            return np.zeros(0), np.zeros(0)
        state = checks.array("q", q, (self.n_q,)), checks.array("v", v, (self.n_q,))
        return self.contacts.state(float(t), *state, np.array(self.p))

    def _check_parts(self) -> None:
        checks.instance("system", self.system, LinearSystem, System)
        checks.instance("name", self.name, str)
        if self.contacts is not None:
            checks.instance("contacts", self.contacts, LinearContacts, Contacts)
        if self.joints is not None:
            checks.instance("joints", self.joints, LinearJoints, Joints)

    def _check_times(self) -> None:
        span = checks.vector("t_span", self.t_span)
        if len(span) != 2:
            raise ValueError(f"t_span: expected two times, got {self.t_span!r}")
        t_start, t_end = float(span[0]), float(span[1])
        if not t_start < t_end:
            raise ValueError(f"t_span: expected t_start < t_end, got {self.t_span!r}")
        object.__setattr__(self, "t_span", (t_start, t_end))
        object.__setattr__(self, "period", checks.period(self.period))
        force = getattr(self.system, "force", None)
        if isinstance(force, Harmonic) and not force.repeats_after(self.period):
            raise ValueError(
                f"period: {self.period!r} s are no whole number of turns of the force, which takes "
                f"{2.0 * math.pi / abs(force.omega):.9g} s for one (omega = {force.omega!r})"
            )
        corners = np.asarray(self.corners)
        if math.isfinite(self.period) and np.any((corners < 0.0) | (corners >= self.period)):
            raise ValueError(f"corners: expected times in [0, {self.period}), got {corners.tolist()}")

    def _check_start(self, g: Array, u: Array) -> None:
        t, q = self.t_span[0], np.asarray(self.q0)
        scale = max(1.0, float(np.max(np.abs(q))))
        inside = np.flatnonzero(g < -ROUNDING * scale)
        if len(inside):
            raise ValueError(
                f"q0: the initial state lies inside the obstacle: the gap of contact {inside[0]} is "
                f"{g[inside[0]]:.6g} m at t = {t:g}, q = {checks.shown(q)}"
            )

    def _starts_exact(self) -> bool:
        if not callable(self.exact):
            raise ValueError(f"exact: expected a function of times, got {self.exact!r}")
        start = self.exact(np.array([self.t_span[0]]))
        if not isinstance(start, (tuple, list)) or len(start) != 2:
            raise ValueError(f"exact: expected a function of times that gives q and v, got {start!r} from it")
        near = []
        for name, x, mine in zip(("q", "v"), start, (self.q0, self.v0), strict=True):
            given = checks.array(f"exact: {name}", x, (1, self.n_q))[0]
            near.append(np.allclose(given, np.asarray(mine), rtol=EXACT_START, atol=EXACT_START))
        return all(near)

    def _check_joints(self, g: Array, u: Array) -> None:
        for name, x, residual in (("q0", self.q0, g), ("v0", self.v0, u)):
            scale = max(1.0, float(np.max(np.abs(np.asarray(x)))))
            off = np.flatnonzero(np.abs(residual) > JOINT_ROUNDING * scale)
            if len(off):
                raise ValueError(
                    f"{name}: the initial state does not satisfy joint {off[0]}: its "
                    f"{'gap' if name == 'q0' else 'rate'} is {residual[off[0]]:.6g} where 0 is expected"
                )
