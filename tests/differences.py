"""Central differences of high order, to judge derivatives that somebody wrote down."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

# Eighth order, on the points -4 .. 4
FIRST = np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0.0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
SECOND = np.array([-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560])
POINTS = np.arange(-4, 5)


def derivative(f: Callable[[float], Any], x: float, step: float) -> Any:
    """df/dx, error of the order of step^8 and rounding/step."""
    return sum(c * np.asarray(f(x + k * step)) for k, c in zip(POINTS, FIRST, strict=True)) / step


def second_derivative(f: Callable[[float], Any], x: float, step: float) -> Any:
    """d2f/dx2, error of the order of step^8 and rounding/step^2."""
    return sum(c * np.asarray(f(x + k * step)) for k, c in zip(POINTS, SECOND, strict=True)) / step**2


def jacobian(f: Callable[[Any], Any], x: Any, step: float) -> Any:
    """df_i/dx_j at a vector x."""
    columns = [derivative(lambda s, e=e: f(x + s * e), 0.0, step) for e in np.eye(len(x))]
    return np.stack(columns, axis=-1)
