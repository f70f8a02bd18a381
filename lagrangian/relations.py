"""Which functions of a scene are derivatives of which: what `derivatives` compares.

Contacts, Joints              gap: jacobian and gap_t;   G v + g_t along the motion: bias
LinearContacts, LinearJoints  motion: s, s', s''
LinearSystem                  frame: c, c', c''
System                        force: force_q and force_v;   mass: its own transpose
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from lagrangian import checks
from lagrangian.asked import Asked, in_python
from lagrangian.checks import Array, Callback
from lagrangian.contacts import Contacts, LinearContacts
from lagrangian.derivatives import Direction, Known, Relation, State, compare, within
from lagrangian.joints import Joints
from lagrangian.system import LinearSystem

if TYPE_CHECKING:
    from lagrangian.scene import Scene

MOST = 8  # directions among the coordinates; where there are more of these, several at a time
APART = 0.01  # of the scale: from the state given to the one looked at, where products of coordinates do not vanish
FASTER = 0.3  # of the scale: the same of the velocities
LATER = 0.0274  # of half the span: the same of the time
LARGE = 4096  # entries of a matrix
GOLDEN = 0.6180339887498949
KNOWN = Known()


def is_large(scene: Scene) -> bool:
    """Whether it takes Python a second to fill its matrices some hundred times: they wait for machine code."""
    c, joints, system = scene.contacts, scene.joints, scene.system
    rows = [scene.n_c if isinstance(c, Contacts) else 0]
    rows += [scene.n_j if isinstance(joints, Joints) and joints.pattern is None else 0]
    rows += [0 if isinstance(system, LinearSystem) else scene.n_q]
    return scene.n_q * max(rows) > LARGE


def check_derivatives(
    scene: Scene, states: Iterable[State], run: bool = False, prepared: Any = in_python
) -> None:
    """Compare every derivative that the scene's functions give; ValueError names the first that is wrong.

    Once for each set of functions and of parameters near the start of a scene, and once near states of a run: what is
    forgotten may be 1 in the first.

    prepared : see `Asked`
    """
    functions = [f for f in _functions(scene) if f is not None]
    if not functions:
        return
    ask = Asked(scene, prepared)
    with KNOWN.look(functions, (scene.n_q, run), np.asarray(scene.p)) as new, np.errstate(all="ignore"):
        for at in states if new else ():
            _check_mass(ask, at)
            _check_arguments(ask, at)
            for relation in _relations(ask, at):
                compare(relation)


def _functions(scene: Scene) -> list[Any]:
    """The functions between which there are relations."""
    found: list[Any] = []
    system = scene.system
    if isinstance(system, LinearSystem):
        found += [system.frame, system.force if callable(system.force) else None]
    else:
        found += [system.mass] if callable(system.mass) else []
        if system.force_q is not None or system.force_v is not None:
            found += [system.force, system.force_q, system.force_v]
    for _, c in _constraints(scene):
        found += [c.motion] if isinstance(c, LinearContacts) else [c.gap, c.gap_t, c.bias]
    found += [f for _, f, _ in _of_friction(scene) if callable(f)]
    for c in (scene.contacts, scene.joints):
        found += [getattr(c, "jacobian", None)]
    return found


def _check_mass(ask: Asked, at: State) -> None:
    """ValueError where the mass is not symmetric: kernels that read one half of it do not notice."""
    mass: Any = getattr(ask.scene.system, "mass", None)
    if callable(mass):
        M = ask.evaluated(mass, (ask.scene.n_q, ask.scene.n_q))(at)
        if np.all(np.isfinite(M)):
            checks.symmetric_mass("system.mass", M)


def _check_arguments(ask: Asked, at: State) -> None:
    """ValueError where what moves by itself depends on the state, or a mass, gap, tangent or belt on velocities.

    No method asks for that: a tangent that follows the sliding never sees it turn about, and holds nothing at rest;
    steps that solve for the force of a linear system ask for it once, and derivatives of a motion not at all.
    """
    (t, q, _), (_, beside, faster) = at, _beside(ask, at, 0.0)
    for name, f, shape in _moving(ask.scene):
        _check_same(name, "time", ask.evaluated(f, shape), at, (t, beside, faster))
    for name, f, shape in _of_places(ask.scene):
        if callable(f):
            _check_same(name, "time and coordinates", ask.evaluated(f, shape), at, (t, q, faster))


def _check_same(name: str, allowed: str, f: Callable[[State], Array], at: State, other: State) -> None:
    """ValueError where a function differs at two states; one that differs from itself is noise."""
    one, another = f(at), f(other)
    if np.any(np.abs(one - another) > 0.0) and np.array_equal(one, f(at), equal_nan=True):
        raise ValueError(
            f"{name}: expected a function of {allowed} alone, but at t = {at[0]:.9g} it is "
            f"{checks.shown(one)} at q = {checks.shown(at[1])}, v = {checks.shown(at[2])}, and "
            f"{checks.shown(another)} at q = {checks.shown(other[1])}, v = {checks.shown(other[2])}"
        )


def _moving(scene: Scene) -> Iterator[tuple[str, Callback | None, tuple[int, ...]]]:
    """What is a function of time: force of a linear system, frame, obstacles, with the shape that they fill."""
    if isinstance(scene.system, LinearSystem):
        force = scene.system.force if callable(scene.system.force) else None
        yield "system.force (that of a System may depend on q and v)", force, (scene.n_q,)
        yield "system.frame", scene.system.frame, (scene.n_q, 3)
    for name, c in _constraints(scene):
        if isinstance(c, LinearContacts):
            yield f"{name}.motion", c.motion, (c.n_c, 3)


def _of_places(scene: Scene) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    """What time and coordinates tell, with the shape that it fills where it is a function."""
    yield "system.mass", getattr(scene.system, "mass", None), (scene.n_q, scene.n_q)
    for name, c in _constraints(scene):
        if not isinstance(c, LinearContacts):
            yield f"{name}.gap", c.gap, (c.n_c,)
    yield from _of_friction(scene)


def _of_friction(scene: Scene) -> Iterator[tuple[str, Any, tuple[int, ...]]]:
    """Tangents and belts of the contacts, with the shape that they fill where they are functions."""
    friction = None if scene.contacts is None else scene.contacts.friction
    if friction is not None:
        yield "friction.tangent", friction.tangent, (scene.n_c, scene.n_q)
        yield "friction.slip", friction.slip, (scene.n_c,)


def _constraints(scene: Scene) -> Iterator[tuple[str, Any]]:
    if scene.contacts is not None:
        yield "contacts", scene.contacts
    if scene.joints is not None:
        yield "joints", scene.joints.as_contacts()


def _relations(ask: Asked, at: State) -> Iterator[Relation]:
    """Every relation of the scene's functions."""
    scene = ask.scene
    system, duration = scene.system, 0.5 * min(scene.t_span[1] - scene.t_span[0], scene.period)
    if isinstance(system, LinearSystem):
        if system.frame is not None:
            yield _chain("system.frame", system.frame, ask, scene.n_q, at, duration)
    elif system.force_q is not None or system.force_v is not None:
        yield _force(ask, system, _beside(ask, at, LATER * within(scene.t_span, at[0], duration)))
    for name, c in _constraints(scene):
        if not isinstance(c, LinearContacts):
            yield _gap(name, c, ask, at, duration)
            if c.bias is not None:
                yield _bias(name, c, ask, _beside(ask, at, 0.0), duration)
        elif c.motion is not None:
            yield _chain(f"{name}.motion", c.motion, ask, c.n_c, at, duration)


def _chain(name: str, f: Callback, ask: Asked, n: int, at: State, duration: float) -> Relation:
    """Rows (x, x', x'') of a function of time."""
    motion = ask.evaluated(f, (n, 3))
    names = lambda row: (f"{name}: out[{row // 2}, {row % 2 + 1}]", f"out[{row // 2}, {row % 2}]")  # noqa: E731
    duration = within(ask.scene.t_span, at[0], duration)
    return Relation(
        value=lambda x: motion(x)[:, :2].ravel(),
        slope=lambda x, along: along[0] * motion(x)[:, 1:].ravel(),
        directions=[Direction(at, _ahead(ask.scene, duration), duration, False, names)],
    )


def _gap(name: str, c: Any, ask: Asked, at: State, duration: float) -> Relation:
    """g with G and g_t."""
    G, g_t = _jacobian(name, c, ask), ask.evaluated(c.gap_t, (c.n_c,))
    given = f"{name}.gap_t" + (" (not given)" if c.gap_t is None else "")
    names = lambda row: (f"{given}[{row}]", f"{name}.gap[{row}]")  # noqa: E731
    duration = within(ask.scene.t_span, at[0], duration)
    in_time = Direction(_beside(ask, at, 0.0), _ahead(ask.scene, duration), duration, False, names)
    base = _beside(ask, at, LATER * duration)
    return Relation(
        value=ask.evaluated(c.gap, (c.n_c,)),
        slope=lambda x, along: along[0] * g_t(x) if along[0] else G(x) @ along[1],
        directions=[*_coordinates(base, 1, f"{name}.jacobian", f"{name}.gap"), in_time],
    )


def _bias(name: str, c: Any, ask: Asked, base: State, duration: float) -> Relation:
    """G v + g_t with its derivative along the motion."""
    G, g_t = _jacobian(name, c, ask), ask.evaluated(c.gap_t, (c.n_c,))
    bias, v = ask.evaluated(c.bias, (c.n_c,)), base[2]
    duration = within(ask.scene.t_span, base[0], min(duration, _size(base[1]) / _size(v)))
    names = lambda row: (f"{name}.bias[{row}]", f"{name}.jacobian v + {name}.gap_t along the motion")  # noqa: E731
    return Relation(
        value=lambda x: G(x) @ v + g_t(x),
        slope=lambda x, along: along[0] * bias(x),
        directions=[Direction(base, (duration, duration * v, 0.0 * v), duration, False, names)],
    )


def _jacobian(name: str, c: Any, ask: Asked) -> Callable[[State], Any]:
    """G of contacts or joints as a function of the state, sparse where it has a pattern."""
    pattern = getattr(ask.scene.joints, "pattern", None) if name == "joints" else None
    if pattern is None:
        return ask.evaluated(c.jacobian, (c.n_c, ask.scene.n_q))
    joints: Any = ask.scene.joints
    entries = ask.evaluated(joints.jacobian, (pattern.shape[1],))
    return lambda x: joints.matrix(entries(x), ask.scene.n_q)


def _force(ask: Asked, system: Any, base: State) -> Relation:
    """f with df/dq and df/dv, those of them that are given."""
    n = ask.scene.n_q
    f_q, f_v = ask.evaluated(system.force_q, (n, n)), ask.evaluated(system.force_v, (n, n))
    by_q = _coordinates(base, 1, "system.force_q", "system.force") if system.force_q is not None else []
    by_v = _coordinates(base, 2, "system.force_v", "system.force") if system.force_v is not None else []
    return Relation(
        value=ask.evaluated(system.force, (n,)),
        slope=lambda x, along: f_q(x) @ along[1] if np.any(along[1]) else f_v(x) @ along[2],
        directions=[*by_q, *by_v],
    )


def _coordinates(base: State, kind: int, derivative: str, function: str) -> list[Direction]:
    """Directions along coordinates (kind 1) or velocities (2), at most MOST of them."""
    n, size = len(base[1]), _size(base[1] if kind == 1 else base[2])

    def direction(members: range) -> Direction:
        along = [np.zeros(n), np.zeros(n)]
        along[kind - 1][members] = size * np.where(np.arange(len(members)) % 2, -1.0, 1.0)
        names = lambda row: (f"{derivative}[{row}, {members[0]}]", f"{function}[{row}]")  # noqa: E731
        singly = tuple(direction(range(j, j + 1)) for j in members) if len(members) > 1 else ()
        return Direction(base, (0.0, along[0], along[1]), size, True, names, singly)

    return [direction(range(j, n, MOST)) for j in range(min(n, MOST))]


def _ahead(scene: Scene, duration: float) -> State:
    """The direction of time."""
    return duration, np.zeros(scene.n_q), np.zeros(scene.n_q)


def _beside(ask: Asked, at: State, later: float) -> State:
    """A state near another, no deeper inside obstacles than needed, at which nothing vanishes by chance."""
    k = np.arange(ask.scene.n_q)
    off = np.where(k % 2, -0.5, 0.5) * (1.0 + GOLDEN * (k + 1) % 1.0)
    t, q, v = at[0] + later, at[1], at[2] + FASTER * _size(at[2]) * off
    sides = [q + APART * _size(q) * sign * off for sign in (1.0, -1.0)]
    if isinstance(ask.scene.contacts, Contacts):
        gap = ask.evaluated(ask.scene.contacts.gap, (ask.scene.n_c,))
        sides.sort(key=lambda x: -float(np.min(gap((t, x, v)))))
    return t, sides[0], v


def _size(x: Array) -> float:
    """The largest of numbers, and not less than one."""
    return max(1.0, float(np.max(np.abs(x))))
