"""Cases of which CI runs a share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest


def shared(cases: Iterable[Any], every: int) -> list[Any]:
    """These values of a parameter: each `every`-th is one of the slow tests, the others are run before a release."""
    marks = pytest.mark.slow, pytest.mark.thorough
    return [pytest.param(x, marks=marks[bool(k % every)]) for k, x in enumerate(cases)]
