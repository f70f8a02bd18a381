"""Cases of which CI runs a share, and those of compiled callbacks."""

from __future__ import annotations

from collections.abc import Container, Iterable
from importlib.util import find_spec
from typing import Any

import pytest

from lcpstep.callbacks.compiling import disabled

COMPILES = not disabled() and find_spec("numba") is not None  # else own callbacks run in plain Python
compiled_only = pytest.mark.skipif(
    not COMPILES, reason="own callbacks are not compiled: numba is missing, or switched off"
)


def slow(cases: Iterable[Any], *long: Any, longest: Container[Any] = ()) -> list[Any]:
    """These values of a parameter: the long ones are slow tests, the longest are run before a release."""

    def mark(x: Any) -> Any:
        return pytest.mark.thorough if x in longest else pytest.mark.slow if x in long else ()

    return [pytest.param(x, marks=mark(x)) for x in cases]


def shared(cases: Iterable[Any], every: int) -> list[Any]:
    """These values of a parameter: each `every`-th is one of the slow tests, the others are run before a release."""
    marks = pytest.mark.slow, pytest.mark.thorough
    return [pytest.param(x, marks=marks[bool(k % every)]) for k, x in enumerate(cases)]


def seeds(number: int, first: int, *marks: Any) -> list[Any]:
    """Seeds below a number for one test: the first, with these marks, and the others, run before a release."""
    others = pytest.param(range(first, number), marks=pytest.mark.thorough, id="others")
    return [pytest.param(range(first), marks=marks, id=f"first {first}"), others]
