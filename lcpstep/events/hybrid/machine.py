"""From a system with modes to what kernels evaluate: tables of its fields, guards and resets, and work space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lagrangian.hybrid import HybridScene, HybridSystem
from lagrangian.modes import BOTH, Guard, Surface
from lcpstep.callbacks import NotCompiled, compiling
from lcpstep.callbacks.faults import name_of
from lcpstep.events.hybrid.field import Machine
from lcpstep.events.hybrid.kinds import ARRIVE, DIFFERENCE, EXIT_ABOVE, EXIT_BELOW, NOT_SLIDING, PLAIN
from lcpstep.kernels.uncompiled import CalledBack
from lcpstep.lengths import ASIDE, lengths

Array = NDArray[np.float64]
SMALL = 1e-2  # size of a motion that is far below one, the length of differences otherwise
TIME_DIFFERENCE = 1e-4  # step of differences in time, of the period or the span


def machine(scene: HybridScene) -> Machine:
    """The system as kernels see it; its functions are C functions, compiled or around Python."""
    system, names = scene.system, scene.system.names
    index = {name: k for k, name in enumerate(names)}
    modes, surfaces = list(system.modes.values()), system.surfaces
    rows = [_rows(system, index, name) for name in names]
    table = [row for group in rows for row in group]
    anything = modes[0].field
    functions: dict[str, list[Any]] = {
        "fields": [mode.field for mode in modes] + [anything for _ in surfaces],
        "surfaces": [anything for _ in modes] + [surface.value for surface in surfaces],
        "values": [value or anything for value, *_ in table],
        "resets": [reset or anything for _, reset, *_ in table],
    }
    once = {id(f): f for fs in functions.values() for f in fs}
    made = {k: _c_function(scene, f) for k, f in once.items()}
    addresses = {name: [made[id(f)][0] for f in fs] for name, fs in functions.items()}
    not_sliding = [NOT_SLIDING] * len(modes)
    integers = {
        "has_reset": [reset is not None for _, reset, *_ in table],
        "first": np.cumsum([0, *map(len, rows)]),
        "at_once": [row[3] for row in table],
        "kind": [row[4] for row in table],
        "target": [row[5] for row in table],
        "below": not_sliding + [index[surface.below] for surface in surfaces],
        "above": not_sliding + [index[surface.above] for surface in surfaces],
    }
    span = min(scene.period, scene.t_span[1] - scene.t_span[0])
    length = _lengths(scene, list(once.values()), span)
    return Machine(
        system.n_x, np.array(scene.p), addresses, integers, [row[2] for row in table], TIME_DIFFERENCE * span,
        length, list(made.values()),
    )  # fmt: skip


def _lengths(scene: HybridScene, functions: list[Any], span: float) -> Array:
    """Lengths for differences, (n_x,): one, or shorter where the motion is small and functions bend within it."""
    system, t, x, p = scene.system, scene.t_span[0], np.array(scene.x0), np.array(scene.p)

    def value(f: Any) -> Any:
        def at(y: Array) -> Array:
            out = np.zeros(system.n_x)  # a guard fills the first
            try:
                f(t, y, p, out)
            except (ValueError, ArithmeticError):  # beyond where it is defined
                out[:] = np.nan
            return out

        return at

    size = np.abs(x)
    if not np.any((size > 0.0) & (size < SMALL)):
        return np.ones(system.n_x)
    rates = np.max([np.abs(value(mode.field)(x)) for mode in system.modes.values()], axis=0)
    size = np.maximum(size, span * rates)
    size[size == 0.0] = 1.0
    found = [lengths(value(f), x + ASIDE * size, DIFFERENCE, size) for f in functions]
    return np.minimum(np.min(found, axis=0), 1.0)


def _rows(
    system: HybridSystem, index: dict[str, int], name: str
) -> list[tuple[Any, Any, float, bool, int, int]]:
    """The guards of a mode: function, reset, sign, whether it acts at once, kind, target."""
    rows = [row for guard in system.guards()[name] for row in _guard_rows(guard, index)]
    for surface in system.surfaces:
        slides = index[surface.sliding]
        if name in (surface.below, surface.above):
            sign = 1.0 if name == surface.below else -1.0
            rows.append((surface.value, None, sign, True, ARRIVE, slides))
        elif name == surface.sliding:
            rows.append((None, None, 1.0, True, EXIT_BELOW, index[surface.below]))
            rows.append((None, None, 1.0, True, EXIT_ABOVE, index[surface.above]))
            rows += _edges(system, index, surface)
    return rows


def _edges(
    system: HybridSystem, index: dict[str, int], surface: Surface
) -> list[tuple[Any, Any, float, bool, int, int]]:
    """Guards of sliding on a surface where it crosses others: beyond them one of its sides is another mode.

    The motion goes on in what lies there: the mode that both sides have become, or sliding between the two, which
    ends at once where they do not attract. Where no surface parts them the guard leads nowhere, for ever (`loop`).
    """
    rows, seen = [], [guard.value for guard in surface.guards]
    for other in system.surfaces:
        for side in (surface.below, surface.above):
            if other is surface or side not in (other.below, other.above) or other.value in seen:
                continue
            from_below = side == other.below
            beyond = {
                _across(system, surface, mode, other.value, from_below)
                for mode in (surface.below, surface.above)
            }
            target = surface.sliding
            for parting in system.surfaces:
                target = parting.sliding if {parting.below, parting.above} == beyond else target
            if len(beyond) == 1:
                (target,) = beyond
            rows.append((other.value, None, 1.0 if from_below else -1.0, True, PLAIN, index[target]))
    return rows


def _across(system: HybridSystem, surface: Surface, mode: str, value: Any, from_below: bool) -> str:
    """The mode that lies across the surface of this function, seen from a mode on one side of it; itself if none."""
    for other in system.surfaces:
        here, there = (other.below, other.above) if from_below else (other.above, other.below)
        if other is not surface and other.value is value and here == mode:
            return there
    return mode


def _guard_rows(guard: Guard, index: dict[str, int]) -> list[tuple[Any, Any, float, bool, int, int]]:
    signs, at_once = [float(guard.direction)], guard.at_once
    if guard.direction == BOTH:
        signs, at_once = [1.0, -1.0], False
    return [(guard.value, guard.reset, sign, at_once, PLAIN, index[guard.target]) for sign in signs]


def _c_function(scene: HybridScene, f: Any) -> tuple[int, CalledBack | None]:
    """Address of a C function: machine code, or what must be kept around what stays in Python."""
    if not compiling.disabled():
        try:
            return compiling.first_order_address(f), None
        except NotCompiled as why:
            compiling.warn(f"{name_of(f)} of scene {scene.name!r}", f, why)
    called_back = CalledBack(f, first_order=True)
    return called_back.address, called_back
