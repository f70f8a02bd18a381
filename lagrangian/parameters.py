"""The numbers p that functions are handed, from the named parameters of a scene; a scene on one line, with these."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lagrangian.checks import Array, ReadOnly, vector

PLAIN = {"b": bool, "i": int, "u": int, "f": float, "U": str}  # of Python's, by the kind of NumPy's


class Values(np.ndarray[Any, np.dtype[np.float64]]):
    """The p of a scene that are the values of its parameters."""


def values(p: ArrayLike | None, parameters: Mapping[str, Any]) -> Array:
    """The p of a scene: as given, or the values of its parameters; ValueError where these are others by now."""
    named = numbers(parameters)
    if p is not None and not isinstance(p, Values):
        return vector("p", p)
    if p is not None and named and p.tolist() != named:
        raise ValueError(
            f"parameters: expected p=None beside new ones, for p to be theirs: it has {p.tolist()} of others"
        )
    return (vector("parameters", named) if p is None else vector("p", p)).view(Values)


def plain(parameters: Mapping[str, Any]) -> ReadOnly:
    """Names and values, read-only; single values of NumPy's as those of Python, which files hold.

    TypeError where they are none.
    """
    if not isinstance(parameters, Mapping):
        raise TypeError(f"parameters: expected names and values, got {parameters!r}")
    return ReadOnly({name: _plain(x) for name, x in parameters.items()})


def _plain(x: Any) -> Any:
    if not isinstance(x, np.generic | np.ndarray) or x.size != 1 or x.dtype.kind not in PLAIN:
        return x
    return PLAIN[x.dtype.kind](x.item())


def numbers(parameters: Mapping[str, Any]) -> list[Any]:
    """The values of parameters that are no text; those of switches as 0 and 1."""
    return [float(x) if isinstance(x, bool) else x for x in parameters.values() if not isinstance(x, str)]


def in_words(scene: Any, parts: list[str]) -> str:
    """A scene on one line: its kind, name, what it has, its span, and its parameters."""
    start, end = scene.t_span
    values = [
        f"{name}={x:g}" if isinstance(x, float) else f"{name}={x!r}" for name, x in scene.parameters.items()
    ]
    words = [repr(scene.name), *parts, f"t = {start:g} .. {end:g} s", *values]
    return f"{type(scene).__name__}({', '.join(words)})"
