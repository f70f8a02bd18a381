"""What the catalogue says of a scene: how to make it, what goes wrong on it, and what its answer is."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType
from typing import Any, ParamSpec, TypeVar

import numpy as np

from lagrangian import checks
from lagrangian.checks import Array
from lagrangian.hybrid import HybridScene
from lagrangian.scene import Scene
from lagrangian.scenes.drawings import drawing_of

P = ParamSpec("P")
S = TypeVar("S", Scene, HybridScene)


def checked(make: Callable[P, S]) -> Callable[P, S]:
    """Check the numbers given to a scene's function before any is used: finite, and in the range of their name.

    A restitution lies in [0, 1]; t_end is positive; what has a whole number as default takes whole numbers only.
    """

    def made(*arguments: P.args, **named: P.kwargs) -> S:
        signature = _signature(make)
        unknown = [name for name in named if name not in signature.parameters]
        if unknown:
            raise TypeError(f"{make.__name__}() has {', '.join(signature.parameters)}, and no {unknown[0]!r}")
        for name, value in signature.bind(*arguments, **named).arguments.items():
            default = signature.parameters[name].default
            if name == "restitution":
                checks.number(name, value, least=0.0, most=1.0)
            elif name == "t_end" and value is not None:
                checks.positive(name, value)
            elif isinstance(default, float):
                checks.number(name, value)
            elif isinstance(default, bool):
                if not isinstance(value, (bool, np.bool_)):
                    raise ValueError(f"{name}: expected True or False, got {value!r}")
            elif isinstance(default, int) and (isinstance(value, bool) or not hasattr(value, "__index__")):
                raise ValueError(f"{name}: expected a whole number, got {value!r}")
        scene = make(*arguments, **named)
        if scene.drawing is None:
            object.__setattr__(scene, "drawing", drawing_of(scene))
        if isinstance(scene.exact, FunctionType):  # made in `make`, so that pickle does not find it
            exact = Exact(result, arguments, named, scene.exact)
            object.__setattr__(scene, "exact", exact)  # new a moment ago, and checked with the same motion
        return scene

    result: Callable[P, S] = functools.wraps(make)(made)
    return result


@functools.cache
def _signature(make: Callable[..., Any]) -> inspect.Signature:
    return inspect.signature(make)


@dataclass(eq=False)
class Exact:
    """The motion of a ready scene in closed form; pickled as the call that makes the scene."""

    make: Callable[..., Any]
    arguments: tuple[Any, ...]
    named: dict[str, Any]
    motion: Callable[[Array], tuple[Array, Array]] | None

    def __call__(self, times: Array) -> tuple[Array, Array]:
        """Q and v at these times."""
        if self.motion is None:
            self.motion = self.make(*self.arguments, **self.named).exact.motion
        return self.motion(times)

    def __getstate__(self) -> dict[str, Any]:
        """All but the function itself."""
        return vars(self) | {"motion": None}


@dataclass(frozen=True)
class Entry:
    """A scene of the catalogue.

    Attributes
    ----------
    make : function of the scene's parameters, all with defaults, that returns the `Scene`, or the `HybridScene`
    hazard : what usually goes wrong, in one line
    answer : what is known of the motion exactly, or checkable without a solver, in one line
    """

    make: Callable[..., Any]
    hazard: str
    answer: str

    @property
    def about(self) -> str:
        """What moves, in one line: the first of the function's docstring."""
        return (inspect.getdoc(self.make) or "").splitlines()[0]

    @property
    def parameters(self) -> dict[str, Any]:
        """The parameters that are numbers or words, with their default values."""
        given = inspect.signature(self.make).parameters.values()
        return {p.name: p.default for p in given if isinstance(p.default, (int, float, str))}
