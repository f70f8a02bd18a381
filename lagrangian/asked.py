"""The functions of a scene, evaluated to be looked at and not to move: zero where there is none, whatever they do."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lagrangian.checks import Array, Callback, read_only
from lagrangian.derivatives import State
from lagrangian.plain import python

if TYPE_CHECKING:
    from lagrangian.scene import Scene


class Asked(NamedTuple):
    """A scene whose functions are evaluated, and by what: `prepared(f, scene, shape)` gives what fills in `out`."""

    scene: Scene
    prepared: Callable[[Callback, Scene, tuple[int, ...]], Callable[[float, Array, Array, Array], None]]

    def evaluated(self, f: Callback | None, shape: tuple[int, ...]) -> Callable[[State], Array]:
        """A callback as a function of the state: zero where there is none, not-a-number where it fails."""
        if f is None:
            return lambda x: np.zeros(shape)
        fill = self.prepared(f, self.scene, shape)

        def value(x: State) -> Array:
            out = np.full(shape, np.nan)
            try:
                fill(*x, out)
            except Exception:  # a state that the motion may never reach
                out.fill(np.nan)
            return out

        return value


def in_python(f: Callback, scene: Scene, _: tuple[int, ...]) -> Callable[[float, Array, Array, Array], None]:
    """A callback that runs in Python alone."""
    g, p = python(f), read_only(np.array(scene.p))
    return lambda t, q, v, out: g(t, read_only(q), read_only(v), p, out)
